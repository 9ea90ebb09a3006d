#pragma once
#include <deque>
#include <filesystem>
#include <string>
#include <vector>

#include "testbench/common/interruption.h"

namespace tessera {

/// Checks before a long run that its folder can be written, without creating it. `key` is what names the folder in
/// messages. Throws InputError.
void check_output_folder(const std::filesystem::path& folder, const std::string& key = "output.folder");

/// A run's folder, made with those above it. What was made goes away again with the object, or an
/// Interruption, unless kept or not empty.
class OutputFolder {
  public:
    explicit OutputFolder(const std::filesystem::path& folder, const std::string& key = "output.folder");
    ~OutputFolder();
    OutputFolder(const OutputFolder&) = delete;
    OutputFolder& operator=(const OutputFolder&) = delete;

    void keep() {
        made_.clear();
        looked_after_.clear();
    }

  private:
    std::vector<std::filesystem::path> made_;  // innermost first
    std::deque<Unfinished> looked_after_;
};

}  // namespace tessera
