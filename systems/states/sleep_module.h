#pragma once
// Components of sleepers, and the systems that carry out their requests.

#include <mobil/engine/module.h>

namespace mobil::inline v0_3 {

Module sleep_module();

}  // namespace mobil::inline v0_3
