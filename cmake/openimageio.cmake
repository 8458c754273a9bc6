# OpenImageIO::OpenImageIO for the whole project. Debian 12's package exports include directories of
# OpenCV, which is no dependency of it and need not be installed: directories that do not exist are
# dropped.
find_package(OpenImageIO REQUIRED GLOBAL)
get_target_property(_directories OpenImageIO::OpenImageIO INTERFACE_INCLUDE_DIRECTORIES)
set(_existing "")
foreach(_directory IN LISTS _directories)
  if(EXISTS "${_directory}")
    list(APPEND _existing "${_directory}")
  endif()
endforeach()
set_target_properties(OpenImageIO::OpenImageIO PROPERTIES
  INTERFACE_INCLUDE_DIRECTORIES "${_existing}")
