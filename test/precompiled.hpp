// Compiled once for all test programs.
#pragma once

#include <gtest/gtest.h>

#include "base/precompiled.hpp"
