#pragma once
#include "systems/gait/gait.h"
