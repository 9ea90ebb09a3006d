#include "testbench/prove/fuzz/fuzz_target.h"

#include <fmt/format.h>

#include "testbench/job/toml_text.h"

namespace tessera::fuzz {

void promise(bool kept, std::string_view what) {
    if (!kept)
        throw BrokenPromise(std::string(what));
}

void promise_message(std::string_view message, std::string_view file) {
    if (message.substr(0, file.size()) != file || message.substr(file.size(), 1) != ":")
        throw BrokenPromise(fmt::format("the message does not begin with \"{}:\": {}", file, message));
    if (message.size() < file.size() + 3)
        throw BrokenPromise(fmt::format("the message is empty: {}", message));
    promise(is_utf8(message), "the message is not UTF-8");
    for (const char c : message) {
        const bool control = (static_cast<unsigned char>(c) < 0x20 && c != '\n') || c == '\x7f';
        if (control)
            throw BrokenPromise(fmt::format("a control character in the message: {}", message));
    }
}

const std::vector<FuzzTarget>& fuzz_targets() {
    static const std::vector<FuzzTarget> targets{
        {"obj", check_obj}, {"ply", check_ply}, {"map", check_map}, {"toml", check_toml}, {"surface", check_surface},
    };
    return targets;
}

}  // namespace tessera::fuzz
