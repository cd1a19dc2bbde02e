# What catkin's fmbpcConfig.cmake includes: the targets (fmbpc::fmbpc_core) and what they need.
include(CMakeFindDependencyMacro)
find_dependency(Eigen3 NO_MODULE)
include(${fmbpc_DIR}/fmbpcTargets.cmake)
