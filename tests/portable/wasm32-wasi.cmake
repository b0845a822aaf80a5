# WebAssembly with Debian's clang-19, lld-19, wasi-libc and libc++-19-dev-wasm32. Relaxed SIMD fuses multiply-adds;
# without it the bits are those of machines without fusing.
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR wasm32)
set(CMAKE_CXX_COMPILER clang++-19)
set(CMAKE_C_COMPILER clang-19)
set(CMAKE_CXX_COMPILER_TARGET wasm32-wasi)
set(CMAKE_C_COMPILER_TARGET wasm32-wasi)
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
find_program(CMAKE_AR NAMES llvm-ar-19 llvm-ar llvm-ar-14 REQUIRED)
find_program(CMAKE_RANLIB NAMES llvm-ranlib-19 llvm-ranlib llvm-ranlib-14 REQUIRED)
option(MOBIL_RELAXED_SIMD "Fused multiply-adds where the browser's processor has them" ON)
# Features of every browser with SIMD, and options for a module of one thread.
set(CMAKE_CXX_FLAGS_INIT "-msimd128 -mbulk-memory -mnontrapping-fptoint -msign-ext -fno-threadsafe-statics -fno-rtti -fignore-exceptions -D_WASI_EMULATED_GETPID")
if(MOBIL_RELAXED_SIMD)
  string(APPEND CMAKE_CXX_FLAGS_INIT " -mrelaxed-simd")
endif()
# -O0 as a link option: otherwise clang runs any wasm-opt in PATH, and older versions do not support relaxed SIMD. The
# preset optimises when the module is linked (-flto, CMakePresets.json). That removes a sixteenth of the code: unused
# functions are dropped, and functions that differ only in types are merged. Inlining is reduced for size.
set(CMAKE_EXE_LINKER_FLAGS_INIT "-O0 -lwasi-emulated-getpid -Wl,-z,stack-size=1048576 -Wl,--strip-all,--compress-relocations -Wl,-mllvm,-enable-merge-functions,-mllvm,-inline-threshold=-50")
# Archives without an index: an llvm-ar older than the compiler cannot read its objects, and the linker needs no index.
foreach(language C CXX)
  set(CMAKE_${language}_ARCHIVE_CREATE "<CMAKE_AR> qcS <TARGET> <LINK_FLAGS> <OBJECTS>")
  set(CMAKE_${language}_ARCHIVE_APPEND "<CMAKE_AR> qS <TARGET> <LINK_FLAGS> <OBJECTS>")
  set(CMAKE_${language}_ARCHIVE_FINISH "")
endforeach()
