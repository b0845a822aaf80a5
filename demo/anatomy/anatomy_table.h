#pragma once
// What an anatomy folder holds, as a table and as JSON.

#include <cstddef>
#include <string>

#include <mobil/assets/import/anatomy_folder.h>

namespace mobil {

/// Faults of any kind.
std::size_t fault_count(const AnatomySurvey& survey);

/// A line a mesh with what it is and what was mended, then one line a fault.
std::string anatomy_table(const AnatomySurvey& survey);

/// The same as members of one object: folder, unit_m, said, meshes, faults.
std::string anatomy_json(const std::string& folder, const AnatomySurvey& survey);

}  // namespace mobil
