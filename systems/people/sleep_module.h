#pragma once
// What sleepers consist of, and where what they are asked leads.

#include "engine/module.h"

namespace mobil {

Module sleep_module();

}  // namespace mobil
