#pragma once
#include <cstdlib>
#include <filesystem>
#include <string>

#include "testbench/tests/support/program_runner.h"

namespace tessera {

/// A checkout to run commands in: copies of the project's scripts, links to everything else, and this build's program
/// in the place where scripts/run builds it. cmake, ctest and gtkwave are stubs: nothing is built, no test runs tests,
/// and no window waits for a user.
class Checkout {
  public:
    Checkout() {
        std::filesystem::create_directories(root() / "tools");
        for (const char* const tool : {"cmake", "ctest", "gtkwave"}) {
            write_all(root() / "tools" / tool, "#!/bin/sh\nexit 0\n");
            std::filesystem::permissions(root() / "tools" / tool, std::filesystem::perms::owner_all);
        }
        for (const auto& entry : std::filesystem::directory_iterator(source_folder())) {
            const std::string name = entry.path().filename().string();
            if (name.rfind("build", 0) != 0 && name != ".git" && name != "scripts" && name != "runs")
                std::filesystem::create_symlink(entry.path(), root() / name);
        }
        // Copied, since a linked script would resolve the path of the original.
        std::filesystem::copy(source_folder() / "scripts", root() / "scripts",
                              std::filesystem::copy_options::recursive);
        for (const char* const preset : {"release", "debug", "asan"}) {
            std::filesystem::create_directories(root() / "build" / preset / "testbench/commands");
            std::filesystem::create_symlink(tessera_program(),
                                            root() / "build" / preset / "testbench/commands/tessera");
        }
    }

    std::filesystem::path root() const { return folder_.path() / "tessera"; }

    ProgramEnd run(const std::string& command) const {
        const std::string path = (root() / "tools").string() + ":" + std::getenv("PATH");
        return run_program(
            {"bash", "-euo", "pipefail", "-c", command}, root(), {},
            {{"PATH", path}, {"HOME", root().string()}, {"DISPLAY", ":0"}, {"TESSERA_SKIP_INSTALL", "1"}});
    }

  private:
    TestFolder folder_;
};

}  // namespace tessera
