// Compiled once for all files of the tool.
#pragma once

#include <nlohmann/json.hpp>

#include "base/precompiled.hpp"
