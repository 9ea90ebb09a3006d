# For packages that ask for SystemC by the name of its own CMake package, which Debian's lacks: CCI's does.
find_package(SystemC QUIET)
set(SystemCLanguage_FOUND ${SystemC_FOUND})
