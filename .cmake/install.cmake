# Installs the libraries with their headers, the program, and the package that find_package(isorim) reads.
# Each room is an export set of its own, so that whoever asks for `solver` alone needs no VTK.
include(CMakePackageConfigHelpers)

set(isorim_package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/isorim)
foreach(room IN LISTS isorim_rooms)
  install(TARGETS isorim_${room} EXPORT isorim-${room}
          ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development)
  install(EXPORT isorim-${room} NAMESPACE isorim:: DESTINATION ${isorim_package_dir} COMPONENT development)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/${room} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/isorim COMPONENT development
          FILES_MATCHING PATTERN "*.h" PATTERN cli EXCLUDE PATTERN picture EXCLUDE PATTERN python EXCLUDE)
endforeach()
install(TARGETS isorim RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program)

# Where Debian's and most other shells look for completions.
install(FILES ${PROJECT_BINARY_DIR}/completion.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions
        RENAME isorim COMPONENT program)
install(FILES ${PROJECT_BINARY_DIR}/completion.zsh DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions
        RENAME _isorim COMPONENT program)
install(FILES ${PROJECT_SOURCE_DIR}/README.md ${PROJECT_SOURCE_DIR}/CHANGELOG.md
        DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/io/manual DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/cases DESTINATION ${CMAKE_INSTALL_DATADIR}/isorim COMPONENT program)

# What the package has to find of VTK is what the room io links of it.
get_target_property(isorim_vtk_components isorim_io LINK_LIBRARIES)
list(FILTER isorim_vtk_components INCLUDE REGEX "^VTK::")
list(TRANSFORM isorim_vtk_components REPLACE "^VTK::" "")
list(JOIN isorim_vtk_components " " isorim_vtk_components)

configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/isorim-config.cmake.in
                              ${PROJECT_BINARY_DIR}/isorim-config.cmake INSTALL_DESTINATION ${isorim_package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/isorim-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/isorim-config.cmake ${PROJECT_BINARY_DIR}/isorim-config-version.cmake
        DESTINATION ${isorim_package_dir} COMPONENT development)
