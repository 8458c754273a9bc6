# Compiles by itself every header that no file of the same name includes before all else (which
# include_rules.py sees to): an object library with one translation unit per header, so that a header
# that leans on what others include before it breaks the build.

# All library targets of the project, collected below `directory`.
function(holdfast_collect_libraries directory result)
  get_property(targets DIRECTORY ${directory} PROPERTY BUILDSYSTEM_TARGETS)
  get_property(subdirectories DIRECTORY ${directory} PROPERTY SUBDIRECTORIES)
  set(found)
  foreach(target IN LISTS targets)
    get_target_property(type ${target} TYPE)
    if(type STREQUAL "STATIC_LIBRARY" OR type STREQUAL "INTERFACE_LIBRARY")
      list(APPEND found ${target})
    endif()
  endforeach()
  foreach(subdirectory IN LISTS subdirectories)
    holdfast_collect_libraries(${subdirectory} below)
    list(APPEND found ${below})
  endforeach()
  set(${result} ${found} PARENT_SCOPE)
endfunction()

set(house_libraries)
foreach(folder core proto server client)
  holdfast_collect_libraries(${PROJECT_SOURCE_DIR}/${folder} below)
  list(APPEND house_libraries ${below})
endforeach()

file(GLOB_RECURSE house_headers CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR}
  ${PROJECT_SOURCE_DIR}/core/*.h ${PROJECT_SOURCE_DIR}/proto/*.h ${PROJECT_SOURCE_DIR}/server/*.h
  ${PROJECT_SOURCE_DIR}/client/*.h ${PROJECT_SOURCE_DIR}/tests/*.h)

set(house_units)
foreach(house_header IN LISTS house_headers)
  string(REGEX REPLACE "h$" "cpp" own_file ${house_header})
  if(EXISTS ${PROJECT_SOURCE_DIR}/${own_file})
    continue()
  endif()
  string(MAKE_C_IDENTIFIER ${house_header} name)
  set(unit ${CMAKE_CURRENT_BINARY_DIR}/headers/${name}.cpp)
  # Written only when it differs, so that configuring again compiles nothing again.
  file(CONFIGURE OUTPUT ${unit} @ONLY
    CONTENT "#include \"@house_header@\"\n")
  list(APPEND house_units ${unit})
endforeach()

add_library(house_headers OBJECT ${house_units})
target_include_directories(house_headers PRIVATE ${PROJECT_SOURCE_DIR})
target_link_libraries(house_headers PRIVATE ${house_libraries} GTest::gtest holdfast_warnings)
# Only whether it compiles matters.
target_compile_options(house_headers PRIVATE -O0 -g0)
