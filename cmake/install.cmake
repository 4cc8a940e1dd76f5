# What `cmake --install` leaves: the two programs (component programs), and the client library for C++ with its headers,
# CMake package and pkg-config file (component library). Shaders are in the server; nothing else is read at run time.
include(CMakePackageConfigHelpers)

install(TARGETS diaphane_cli diaphane-server RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT programs)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT programs)

install(TARGETS diaphane_client_shared EXPORT diaphane
        LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT library)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/client/include/diaphane DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT library)

set(server_program ${CMAKE_INSTALL_BINDIR}/diaphane-server)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/diaphane)
install(EXPORT diaphane NAMESPACE diaphane:: FILE diaphane-targets.cmake DESTINATION ${package_dir} COMPONENT library)
configure_package_config_file(cmake/diaphane-config.cmake.in ${CMAKE_CURRENT_BINARY_DIR}/diaphane-config.cmake
                              INSTALL_DESTINATION ${package_dir} PATH_VARS server_program NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/diaphane-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/diaphane-config.cmake ${CMAKE_CURRENT_BINARY_DIR}/diaphane-config-version.cmake
        DESTINATION ${package_dir} COMPONENT library)

# The prefix is found from the file itself, so that the tree may be moved.
file(RELATIVE_PATH prefix_from_pkgconfig /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
string(REGEX REPLACE "/$" "" prefix_from_pkgconfig ${prefix_from_pkgconfig})
configure_file(cmake/diaphane.pc.in ${CMAKE_CURRENT_BINARY_DIR}/diaphane.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/diaphane.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT library)
