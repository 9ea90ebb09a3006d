#pragma once
#include <catch2/catch.hpp>
#include <initializer_list>
#include <string>
#include <vector>

#include "testbench/common/error.h"

namespace tessera::testing {

/// The message of the InputError that the action throws; empty if it throws none.
template <class Action>
std::string input_error_of(Action action) {
    try {
        action();
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

/// A user's input, and what the message must contain; nothing: it is accepted.
struct Refusal {
    std::string input;
    std::vector<std::string> says;
};

/// error_of(input): the message, empty if there is none.
template <class ErrorOf>
void expect_refusals(std::initializer_list<Refusal> rows, ErrorOf error_of) {
    for (const Refusal& row : rows) {
        const std::string error = error_of(row.input);
        CAPTURE(row.input, error);
        CHECK(error.empty() == row.says.empty());
        for (const std::string& part : row.says)
            CHECK_THAT(error, Catch::Contains(part));
    }
}

}  // namespace tessera::testing
