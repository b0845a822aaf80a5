# 64-bit ARM with Debian's g++-aarch64-linux-gnu; its programs run under qemu-user.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
set(CMAKE_C_COMPILER aarch64-linux-gnu-gcc)
set(CMAKE_CXX_FLAGS_INIT "-march=armv8-a+crypto")  # as in Highway for NEON
set(CMAKE_EXE_LINKER_FLAGS_INIT -static)
