# For packages such as CCI that look for SystemC's own CMake package, which Debian does not provide.
find_package(SystemC QUIET)
set(SystemCLanguage_FOUND ${SystemC_FOUND})
