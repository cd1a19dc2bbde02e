# SUNDIALS::cvode and SUNDIALS::nvecserial: from SUNDIALS' own package (5 and newer), else (3 and 4 have none) by file names.
find_package(SUNDIALS QUIET)
if(NOT TARGET SUNDIALS::cvode)
  find_path(FMBPC_SUNDIALS_INCLUDE cvode/cvode.h)
  find_library(FMBPC_SUNDIALS_cvode sundials_cvode)
  get_filename_component(folder "${FMBPC_SUNDIALS_cvode}" DIRECTORY)
  foreach(library nvecserial sunmatrixdense sunlinsoldense sunnonlinsolfixedpoint)
    find_library(FMBPC_SUNDIALS_${library} sundials_${library} PATHS "${folder}" NO_DEFAULT_PATH)  # not of another version
  endforeach()
  if(NOT FMBPC_SUNDIALS_INCLUDE OR NOT FMBPC_SUNDIALS_cvode OR NOT FMBPC_SUNDIALS_nvecserial)
    message(FATAL_ERROR "SUNDIALS with CVODE not found (Debian: libsundials-dev)")
  endif()
  set(libraries)
  foreach(library nvecserial sunmatrixdense sunlinsoldense sunnonlinsolfixedpoint)  # 3 has no nonlinear solvers of its own
    if(FMBPC_SUNDIALS_${library})
      list(APPEND libraries ${FMBPC_SUNDIALS_${library}})
    endif()
  endforeach()
  #catkin_lint: ignore_once order_violation
  #catkin_lint: ignore_once catkin_order_violation
  add_library(SUNDIALS::cvode INTERFACE IMPORTED)
  set_target_properties(SUNDIALS::cvode PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "${FMBPC_SUNDIALS_INCLUDE}"
    INTERFACE_LINK_LIBRARIES "${FMBPC_SUNDIALS_cvode};${libraries}")
  #catkin_lint: ignore_once order_violation
  #catkin_lint: ignore_once catkin_order_violation
  add_library(SUNDIALS::nvecserial INTERFACE IMPORTED)
endif()
