# Fuzz targets, each a separate program: see tests/fuzz/fuzz_input.h.
set(demo ${PROJECT_SOURCE_DIR}/demo)
add_library(fuzz_parts STATIC EXCLUDE_FROM_ALL ${demo}/walk/walk_script.cpp ${demo}/walk/gait_parameters.cpp
  ${demo}/program/nearest_name.cpp ${demo}/program/units.cpp)
target_include_directories(fuzz_parts PUBLIC ${PROJECT_SOURCE_DIR})
target_link_libraries(fuzz_parts PUBLIC mobil_flags fmt::fmt mobil_import mobil_systems mobil_c -fsanitize=fuzzer)
foreach(target mesh gltf anatomy table script command snapshot calls)
  add_executable(fuzz_${target} EXCLUDE_FROM_ALL fuzz/entry.cpp)
  target_compile_definitions(fuzz_${target} PRIVATE FUZZ_HEADER="tests/fuzz/${target}_target.h" FUZZ=fuzz_${target})
  target_link_libraries(fuzz_${target} PRIVATE fuzz_parts)
endforeach()
