#pragma once
// What sleepers consist of, and where what they are asked leads.

#include <mobil/engine/module.h>

namespace mobil::inline v0_3 {

Module sleep_module();

}  // namespace mobil::inline v0_3
