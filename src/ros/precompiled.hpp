// Compiled once for all files of the nodes' library.
#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/ros.h>

#include "base/precompiled.hpp"
