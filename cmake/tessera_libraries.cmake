# The libraries that tessera uses: CMake's name, Debian's package, the least version accepted, the newest one tried, and
# whether the program or only its tests need it. These are Debian 12's and 13's versions, on which scripts/check debian
# builds; README.md shows them. scripts/install reads these lines. -: no version is known to CMake.
set(tessera_libraries
  SystemC        libsystemc-dev        2.3.4    3.0.1   run
  glm            libglm-dev            0.9.9.8  0.9.9.8 run
  OpenEXR        libopenexr-dev        3.1.5    3.1.13  run
  PNG            libpng-dev            1.6.39   1.6.48  run
  tomlplusplus   libtomlplusplus-dev   3.3      3.4     run
  CLI11          libcli11-dev          2.1.2    2.4.1   run
  nlohmann_json  nlohmann-json3-dev    3.11.2   3.11.3  run
  fmt            libfmt-dev            9.1      10.1    run
  embree         libembree-dev         3.13.5   4.3.3   run
  Catch2         catch2                2.13.10  3.7.1   test
  benchmark      libbenchmark-dev      1.7.1    1.9.1   test
  tinyobjloader  libtinyobjloader-dev  2        2       test
  rapidcheck     librapidcheck-dev     -        -       test)

# tessera_find(NAME ARGUMENT...): find_package, for a version of the list. One that is older does not count as found,
# and tessera_not_found has the reason; a newer major version than any tried gives a warning.
macro(tessera_find name)
  set(tessera_find_arguments ${ARGN})
  set(tessera_not_found "${name} was not found")
  find_package(${name} ${tessera_find_arguments})
  if(${name}_FOUND)
    tessera_judge_version(${name})
  endif()
endmacro()

function(tessera_judge_version name)
  list(FIND tessera_libraries ${name} first)
  list(SUBLIST tessera_libraries ${first} 4 row)
  list(GET row 1 package)
  list(GET row 2 least)
  list(GET row 3 newest)
  set(version ${${name}_VERSION})
  if(NOT version)
    set(version ${${name}_VERSION_STRING})
  endif()
  if(NOT version OR least STREQUAL "-")
    return()
  endif()
  string(REGEX MATCH "^[0-9]+" major "${version}")
  string(REGEX MATCH "^[0-9]+" newest_major "${newest}")
  set(this "${name} ${version}")
  if(${name}_DIR)
    string(APPEND this ", in ${${name}_DIR},")
  endif()
  if(version VERSION_LESS least)
    set(reason "${this} is older than ${least}. On Debian 12 or 13: scripts/install, or apt-get install ${package}")
    if("REQUIRED" IN_LIST tessera_find_arguments)
      message(FATAL_ERROR "${reason}")
    endif()
    set(${name}_FOUND FALSE PARENT_SCOPE)
    set(tessera_not_found "${reason}" PARENT_SCOPE)
  elseif(major GREATER newest_major)
    get_property(told GLOBAL PROPERTY tessera_told_of_${name})
    set_property(GLOBAL PROPERTY tessera_told_of_${name} TRUE)
    if(NOT told)
      message(WARNING "${this} is newer than any that tessera was tried with: ${least} to ${newest}. "
                      "If the build fails, install one of these")
    endif()
  endif()
endfunction()
