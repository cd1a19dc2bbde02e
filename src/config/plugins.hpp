// Plants and controllers of other packages: shared libraries that register theirs as ours do, when
// they are loaded.
#pragma once

#include <string>
#include <vector>

namespace fpc {

/// The folder of libfmbpc_core itself; empty where that cannot be known.
std::string libraryFolder();

/// Folders in which a library is looked for by name, in this order: ${FMBPC_PLUGIN_PATH}, `lib` of
/// every prefix of ${CMAKE_PREFIX_PATH} (a catkin workspace, an install prefix) and of every
/// install space of ${ROS_PACKAGE_PATH}, and the folder of fmbpc itself.
std::vector<std::string> pluginFolders();

/// Loads `name`: a library NAME as libNAME.so out of pluginFolders(), or a path (with a slash).
/// Once loaded it stays; loading it again does nothing.
/// @throws InputError naming `where` if there is none, if it is no library or does not fit this
/// fmbpc, if it registers nothing, or a type whose name is taken.
void loadPlugin(const std::string& name, const std::string& where);

/// True if the name is a path.
bool isPluginPath(const std::string& name);

}  // namespace fpc
