#include "testbench/tests/support/source_folder.h"

namespace tessera {

std::filesystem::path source_folder() {
    return TESSERA_SOURCE_DIR;
}

}  // namespace tessera
