# Dependencies as headers alone: for other machines and the browser, where they need not be built for the target, and for
# libraries that need no others (MOBIL_SELF_CONTAINED).
set(MOBIL_HEADERS_FROM /usr/include CACHE PATH "Where the headers of Eigen (eigen3), Highway, fmt and tl::expected are")
set(others ${PROJECT_BINARY_DIR}/others)  # only these, without other headers in the same folder
file(MAKE_DIRECTORY ${others})
foreach(folder hwy fmt tl eigen3)
  if(NOT EXISTS ${MOBIL_HEADERS_FROM}/${folder})
    message(FATAL_ERROR "${MOBIL_HEADERS_FROM}/${folder} is not there; install the headers, or set MOBIL_HEADERS_FROM")
  endif()
  file(CREATE_LINK ${MOBIL_HEADERS_FROM}/${folder} ${others}/${folder} SYMBOLIC)
endforeach()
foreach(target Eigen3::Eigen hwy::hwy tl::expected fmt::fmt)
  add_library(${target} INTERFACE IMPORTED)
  target_include_directories(${target} SYSTEM INTERFACE ${others} ${others}/eigen3)
endforeach()
target_compile_definitions(fmt::fmt INTERFACE FMT_HEADER_ONLY "FMT_STATIC_THOUSANDS_SEPARATOR=','")  # no std::locale
if(MOBIL_PORTABLE)
  target_compile_definitions(hwy::hwy INTERFACE HWY_COMPILE_ONLY_STATIC)
else()
  target_compile_definitions(hwy::hwy INTERFACE MOBIL_OWN_TARGETS)
endif()
