# What catkin's fmbpcConfig.cmake includes: the targets (fmbpc::fmbpc_core) and what they need. In a workspace that builds fmbpc
# itself the target is there already, and its file not yet.
include(CMakeFindDependencyMacro)
find_dependency(Eigen3 NO_MODULE)
if(NOT TARGET fmbpc_core)
  include(${fmbpc_DIR}/fmbpcTargets.cmake)
elseif(NOT TARGET fmbpc::fmbpc_core)
  add_library(fmbpc::fmbpc_core ALIAS fmbpc_core)
endif()
