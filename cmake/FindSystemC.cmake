# Finds SystemC: a target of that name, else its own CMake package, then pkg-config. Gives the target SystemC::systemc.
#
# SystemC built for another C++ standard fails only at link time. This module detects that at configure time
# and reports it, also in SystemC_NOT_FOUND_REASON.
set(SystemC_NOT_FOUND_REASON
  "neither its CMake package SystemCLanguage nor pkg-config's systemc is there. On Debian 12: scripts/install, \
or apt-get install libsystemc-dev pkg-config. For a SystemC of your own: -DSystemCLanguage_DIR=... or \
PKG_CONFIG_PATH")
set(SystemC_FOUND FALSE)
if(TARGET SystemC::systemc)
  set(SystemC_FOUND TRUE)
else()
  find_package(SystemCLanguage CONFIG QUIET)
  if(SystemCLanguage_FOUND)
    set(SystemC_FOUND TRUE)
    set(SystemC_VERSION ${SystemCLanguage_VERSION})
  else()
    find_package(PkgConfig QUIET)
    if(PkgConfig_FOUND)
      pkg_check_modules(SYSTEMC QUIET IMPORTED_TARGET systemc)
    endif()
    if(SYSTEMC_FOUND)
      set(SystemC_FOUND TRUE)
      set(SystemC_VERSION ${SYSTEMC_VERSION})
      add_library(SystemC::systemc INTERFACE IMPORTED)
      target_link_libraries(SystemC::systemc INTERFACE PkgConfig::SYSTEMC)
    endif()
  endif()
endif()

# A function, to have local variables.
function(tessera_check_systemc_links)
  get_target_property(imported SystemC::systemc IMPORTED)
  if(NOT imported)
    return()  # part of the same build, so it does not exist yet
  endif()
  # The standard of targets that require at least C++17.
  if(NOT CMAKE_CXX_STANDARD)
    set(CMAKE_CXX_STANDARD ${CMAKE_CXX_STANDARD_DEFAULT})
  endif()
  if(NOT CMAKE_CXX_STANDARD MATCHES "^(17|2[0-9])$")
    set(CMAKE_CXX_STANDARD 17)
  endif()
  # The result is cached per standard, and a failure is not cached: the next configure must detect it again.
  set(systemc_links TESSERA_SYSTEMC_LINKS_WITH_CXX${CMAKE_CXX_STANDARD})
  include(CheckCXXSourceCompiles)
  include(CMakePushCheckState)
  cmake_push_check_state(RESET)
  set(CMAKE_REQUIRED_LIBRARIES SystemC::systemc)
  set(CMAKE_REQUIRED_QUIET TRUE)
  check_cxx_source_compiles("#include <systemc>\nint sc_main(int, char**) { return 0; }" ${systemc_links})
  cmake_pop_check_state()
  if(NOT ${systemc_links})
    unset(${systemc_links} CACHE)
    set(SystemC_FOUND FALSE PARENT_SCOPE)
    set(SystemC_NOT_FOUND_REASON
      "SystemC was found, but a C++${CMAKE_CXX_STANDARD} program does not link with it. The installed SystemC \
was most likely built for another C++ standard (the symbol sc_api_version_*_cxx2xxxxx in its library \
names which). Use the same for tessera and all that is linked with it: Debian 12's libsystemc-dev is built for C++17, \
which is tessera's default. For another SystemC configure with -DCMAKE_CXX_STANDARD=..., 17 or later, or rebuild \
SystemC with -DCMAKE_CXX_STANDARD=17. The linker's own words are in CMakeFiles/CMakeError.log in the build folder." PARENT_SCOPE)
  endif()
endfunction()
if(SystemC_FOUND)
  tessera_check_systemc_links()
endif()

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(SystemC
  REQUIRED_VARS SystemC_FOUND
  VERSION_VAR SystemC_VERSION
  REASON_FAILURE_MESSAGE "${SystemC_NOT_FOUND_REASON}")
