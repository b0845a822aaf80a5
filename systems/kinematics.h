#pragma once
#include "systems/kinematics/kinematics.h"
