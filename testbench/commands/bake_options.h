#pragma once
#include <string>

#include "testbench/commands/bake_command.h"

namespace CLI {  // NOLINT(readability-identifier-naming): the library's name
class App;
class Option;
}  // namespace CLI

namespace tessera {

/// The command-line options of `tessera bake`.
class BakeOptions {
  public:
    /// Declares the options. The object must outlive the parsing.
    void add_to(CLI::App& bake);

    /// Throws InputError with option, value, limit and remedy.
    BakeRequest request() const;

  private:
    std::string surface_, mesh_, output_, size_ = "256x256";
    CLI::Option* mesh_given_ = nullptr;
};

}  // namespace tessera
