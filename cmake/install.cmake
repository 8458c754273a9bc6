# Installs the programs, and the client library for find_package(holdfast).
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(holdfast_libraries holdfast_chunks holdfast_client holdfast_frame holdfast_isa holdfast_proto holdfast_wire)
set(holdfast_cmake_dir ${CMAKE_INSTALL_LIBDIR}/cmake/holdfast)

# Headers of the core quote each other from the top of the tree ("core/frame/plane.h"), which is
# include/holdfast when installed.
target_include_directories(holdfast_frame PUBLIC
  $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/holdfast>)
target_include_directories(holdfast_client PUBLIC
  $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)

install(TARGETS ${holdfast_libraries} EXPORT holdfast_targets
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT sdk)
install(DIRECTORY client/sdk/include/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT sdk)
install(DIRECTORY core/frame DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/holdfast/core COMPONENT sdk
        FILES_MATCHING PATTERN "*.h")
install(DIRECTORY proto/holdfast DESTINATION ${CMAKE_INSTALL_DATADIR}/holdfast/proto COMPONENT sdk
        FILES_MATCHING PATTERN "*.proto")
install(EXPORT holdfast_targets NAMESPACE holdfast:: FILE holdfast-targets.cmake
        DESTINATION ${holdfast_cmake_dir} COMPONENT sdk)
configure_package_config_file(cmake/holdfast-config.cmake.in
  ${CMAKE_CURRENT_BINARY_DIR}/holdfast-config.cmake INSTALL_DESTINATION ${holdfast_cmake_dir})
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/holdfast-config-version.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/holdfast-config.cmake
              ${CMAKE_CURRENT_BINARY_DIR}/holdfast-config-version.cmake
        DESTINATION ${holdfast_cmake_dir} COMPONENT sdk)

install(TARGETS holdfast holdfast-server
        RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT programs)
