#pragma once
#include <string>
#include <vector>

#include "testbench/commands/tune_command.h"

namespace CLI {  // NOLINT(readability-identifier-naming): the library's name
class App;
class Option;
}  // namespace CLI

namespace tessera {

/// The command-line options of `tessera tune`.
class TuneOptions {
  public:
    /// Declares the options. The object must outlive the parsing.
    void add_to(CLI::App& tune);

    /// Throws InputError with option, value, limit and remedy.
    TuneOrder order() const;

  private:
    TuneOrder order_;
    std::string metric_ = "rms";
    std::vector<std::string> vary_;
    CLI::Option* job_given_ = nullptr;
    CLI::Option* triangles_given_ = nullptr;
    CLI::Option* error_given_ = nullptr;
    CLI::Option* vary_given_ = nullptr;
};

}  // namespace tessera
