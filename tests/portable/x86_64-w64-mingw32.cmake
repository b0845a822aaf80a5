# Windows with Debian's g++-mingw-w64-x86-64-posix; its programs run under wine64.
set(CMAKE_SYSTEM_NAME Windows)
set(CMAKE_SYSTEM_PROCESSOR x86_64)
set(CMAKE_CXX_COMPILER x86_64-w64-mingw32-g++-posix)
set(CMAKE_C_COMPILER x86_64-w64-mingw32-gcc-posix)
# Vectors of 128 bits, because this compiler does not align wider ones on Windows' stack. Multiply-adds are still fused.
# Without errno square roots are the processor's; those of MinGW's function can differ in the last bit. Without its
# vectoriser of straight code gcc 12 fuses multiply-adds only where the source does, as -ffp-contract=off says.
set(CMAKE_CXX_FLAGS_INIT
    "-march=x86-64-v2 -mfma -maes -mpclmul -fno-math-errno -fno-tree-slp-vectorize -Wa,-mbig-obj")
set(CMAKE_EXE_LINKER_FLAGS_INIT -static)
set(CMAKE_SHARED_LINKER_FLAGS_INIT -static)
