#pragma once
// Version of these headers. CMakeLists.txt has the same numbers, and the inline namespaces the first two.

#define MOBIL_VERSION_MAJOR 0
#define MOBIL_VERSION_MINOR 3
#define MOBIL_VERSION_PATCH 0
#define MOBIL_VERSION "0.3.0"
