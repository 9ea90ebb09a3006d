#pragma once
#include <string>
#include <vector>

#include "testbench/commands/render_command.h"

namespace CLI {  // NOLINT(readability-identifier-naming): the library's name
class App;
class Option;
}  // namespace CLI

namespace tessera {

/// The command-line options of `tessera render`. Ranges are checked here, before a run is read.
class RenderOptions {
  public:
    /// Declares the options. The object must outlive the parsing.
    void add_to(CLI::App& render);

    /// Throws InputError with option, value, limit and remedy.
    RenderRequest request() const;

  private:
    std::string run_, output_, size_;
    std::vector<std::string> views_;
    std::vector<double> eye_, target_, up_, zoom_;
    double field_of_view_ = 0, line_width_ = 0, error_scale_ = 0;
    bool whole_viewport_ = false;
    CLI::Option* field_of_view_given_ = nullptr;
    CLI::Option* line_width_given_ = nullptr;
    CLI::Option* error_scale_given_ = nullptr;
    CLI::Option* output_given_ = nullptr;
    CLI::Option* size_given_ = nullptr;
};

}  // namespace tessera
