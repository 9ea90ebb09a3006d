#pragma once
#include <string>

#include "testbench/commands/widths_command.h"

namespace CLI {  // NOLINT(readability-identifier-naming): the library's name
class App;
class Option;
}  // namespace CLI

namespace tessera {

/// The command-line options of `tessera widths`.
class WidthsOptions {
  public:
    /// Declares the options. The object must outlive the parsing.
    void add_to(CLI::App& widths);

    /// Throws InputError with option, value, limit and remedy.
    WidthsOrder order() const;

  private:
    WidthsOrder order_;
    std::string bits_;
    double flips_ = 0, error_ = 0;
    CLI::Option* job_given_ = nullptr;
    CLI::Option* bits_given_ = nullptr;
    CLI::Option* flips_given_ = nullptr;
    CLI::Option* error_given_ = nullptr;
};

}  // namespace tessera
