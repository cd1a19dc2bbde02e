# Where the Python package is put together: beside the messages that catkin generates for a package of the same name. Its empty
# __init__.py, made where there is none, is overwritten by ours.
if(FMBPC_WITH_ROS)
  set(FMBPC_PYTHON_BUILD ${CATKIN_DEVEL_PREFIX}/${CATKIN_GLOBAL_PYTHON_DESTINATION}/fmbpc)
  set(FMBPC_PYTHON ${CATKIN_GLOBAL_PYTHON_DESTINATION}/fmbpc)
else()
  set(FMBPC_PYTHON_BUILD ${CMAKE_BINARY_DIR}/python/fmbpc)
  set(FMBPC_PYTHON lib/python3/dist-packages/fmbpc CACHE STRING "Folder of the Python package below the prefix")
endif()
file(GLOB_RECURSE FMBPC_PYTHON_FILES RELATIVE ${PROJECT_SOURCE_DIR}/python/fmbpc CONFIGURE_DEPENDS
  ${PROJECT_SOURCE_DIR}/python/fmbpc/*.py ${PROJECT_SOURCE_DIR}/python/fmbpc/py.typed)
foreach(file ${FMBPC_PYTHON_FILES})
  configure_file(${PROJECT_SOURCE_DIR}/python/fmbpc/${file} ${FMBPC_PYTHON_BUILD}/${file} COPYONLY)
  get_filename_component(folder ${file} DIRECTORY)
  install(FILES ${PROJECT_SOURCE_DIR}/python/fmbpc/${file} DESTINATION ${FMBPC_PYTHON}/${folder})
endforeach()
# The ways between installed folders, so that all of it may stand below any prefix.
get_filename_component(package /prefix/${FMBPC_PYTHON} ABSOLUTE)
get_filename_component(package_parent ${package} DIRECTORY)
file(RELATIVE_PATH FMBPC_PYTHON_TO_LIBRARY ${package} /prefix/${FMBPC_LIB})
file(RELATIVE_PATH FMBPC_LIBRARY_TO_CONFIG /prefix/${FMBPC_LIB} /prefix/${FMBPC_SHARE}/config)
file(RELATIVE_PATH FMBPC_CONFIG_TO_PYTHON /prefix/${FMBPC_SHARE}/config ${package_parent})
