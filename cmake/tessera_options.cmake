# Compiler settings of all our targets. They do not apply to clients of the libraries.
#  * with TESSERA_WERROR warnings are errors; libraries are SYSTEM includes
#  * -fno-plt, -falign-functions: save 5 % of timed mode, which calls the SystemC kernel eight times per edge
#  * -fmacro-prefix-map: reports give paths relative to the project, and object files are equal in all checkouts
#  * -mmemcpy-strategy, -mmemset-strategy: gcc copies structures of some hundred bytes, such as a triangle, with
#    rep movs, which is slow to start; SSE loops save 10 % of functional mode
#  * -ffp-contract=off: the golden model's doubles must not depend on the compiler fusing a multiply-add
add_library(tessera_options INTERFACE)
target_compile_features(tessera_options INTERFACE cxx_std_17)
target_compile_options(tessera_options INTERFACE
  -Wall -Wextra -Wpedantic $<$<BOOL:${TESSERA_WERROR}>:-Werror> -Wshadow -Wconversion -Wsign-conversion
  $<$<COMPILE_LANGUAGE:CXX>:-Wold-style-cast> $<$<COMPILE_LANGUAGE:CXX>:-Wnon-virtual-dtor> -Wcast-align -ffp-contract=off -fno-plt -falign-functions=32
  -fmacro-prefix-map=${PROJECT_SOURCE_DIR}/=)
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64|amd64")
  set(strategy vector_loop:2048:noalign,libcall:-1:noalign)
  target_compile_options(tessera_options INTERFACE
    $<$<COMPILE_LANG_AND_ID:CXX,GNU>:-mmemcpy-strategy=${strategy}>
    $<$<COMPILE_LANG_AND_ID:CXX,GNU>:-mmemset-strategy=${strategy}>)
endif()
if(CMAKE_UNITY_BUILD AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # gcc treats joined sources as headers.
  target_compile_options(tessera_options INTERFACE $<$<COMPILE_LANGUAGE:CXX>:-Wno-subobject-linkage>)
endif()
target_include_directories(tessera_options INTERFACE ${PROJECT_SOURCE_DIR})
if(TESSERA_SANITIZE)
  set(sanitize -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer)
  # With instrumentation gcc's warnings have false positives: no errors here.
  target_compile_options(tessera_options INTERFACE ${sanitize} -Wno-error)
  target_compile_definitions(tessera_options INTERFACE TESSERA_SANITIZE)
  target_link_options(tessera_options INTERFACE ${sanitize})
endif()
if(TESSERA_COVERAGE)
  if(NOT CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
    message(FATAL_ERROR "TESSERA_COVERAGE counts with clang; the compiler is ${CMAKE_CXX_COMPILER}. "
                        "Configure with -DCMAKE_CXX_COMPILER=clang++, or: cmake --preset coverage")
  endif()
  target_compile_options(tessera_options INTERFACE -fprofile-instr-generate -fcoverage-mapping)
  target_compile_definitions(tessera_options INTERFACE TESSERA_COVERAGE)
  target_link_options(tessera_options INTERFACE -fprofile-instr-generate)
endif()
if(TESSERA_FUZZ)
  if(NOT CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
    message(FATAL_ERROR "TESSERA_FUZZ needs clang, which has libFuzzer; this is ${CMAKE_CXX_COMPILER_ID}. "
                        "Take the preset: cmake --preset fuzz")
  endif()
  include(CheckCXXSourceCompiles)
  set(CMAKE_REQUIRED_FLAGS -fsanitize=fuzzer)
  check_cxx_source_compiles(
    "extern \"C\" int LLVMFuzzerTestOneInput(const unsigned char*, decltype(sizeof 0)) { return 0; }"
    TESSERA_HAS_LIBFUZZER)
  unset(CMAKE_REQUIRED_FLAGS)
  if(NOT TESSERA_HAS_LIBFUZZER)
    message(FATAL_ERROR "clang does not link with -fsanitize=fuzzer. On Debian: apt-get install clang libclang-rt-dev")
  endif()
  set(fuzz -fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_compile_options(tessera_options INTERFACE ${fuzz})
  target_link_options(tessera_options INTERFACE ${fuzz})
endif()

# golden and testbench, no libraries for others, use SSE4.1 if this machine has it: floor() is one instruction, which
# saves 6 % of a run with all checks. -DTESSERA_HOST_HAS_SSE41=OFF turns it off.
if(NOT CMAKE_CROSSCOMPILING)
  include(CheckCXXSourceRuns)
  check_cxx_source_runs("int main() { return __builtin_cpu_supports(\"sse4.1\") ? 0 : 1; }" TESSERA_HOST_HAS_SSE41)
endif()

# tessera_add_library(name SOURCES ... LIBRARIES ...): a static library of the testbench with our settings.
function(tessera_add_library name)
  cmake_parse_arguments(arg "" "" "SOURCES;LIBRARIES;PRIVATE_LIBRARIES" ${ARGN})
  add_library(${name} STATIC ${arg_SOURCES})
  target_link_libraries(${name} PUBLIC tessera_options ${arg_LIBRARIES} PRIVATE ${arg_PRIVATE_LIBRARIES})
  target_compile_options(${name} PRIVATE $<$<AND:$<BOOL:${TESSERA_HOST_HAS_SSE41}>,$<COMPILE_LANGUAGE:CXX>>:-msse4.1>)
endfunction()
