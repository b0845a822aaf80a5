#pragma once
// Of which version these headers are. CMakeLists.txt says the same, and namespaces say its first two numbers.

#define MOBIL_VERSION_MAJOR 0
#define MOBIL_VERSION_MINOR 3
#define MOBIL_VERSION_PATCH 0
#define MOBIL_VERSION "0.3.0"
