#pragma once
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <exception>

#include "testbench/common/error.h"

namespace tessera {

/// The end of a program of prove/: parses its arguments and returns what `work` does, or tells an error and returns its
/// exit code. `name`: the program's, in messages.
template <class Work>
int run_program(const char* name, CLI::App& app, int argc, char** argv, const Work& work) {
    const auto fail = [&](const std::exception& error, ExitCode code) {
        fmt::print(stderr, "{}: {}\n", name, error.what());
        return static_cast<int>(code);
    };
    try {
        app.parse(argc, argv);
        return work();
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : static_cast<int>(ExitCode::bad_input);
    } catch (const InputError& error) {
        return fail(error, ExitCode::bad_input);
    } catch (const std::exception& error) {
        return fail(error, ExitCode::resource_limit);
    }
}

}  // namespace tessera
