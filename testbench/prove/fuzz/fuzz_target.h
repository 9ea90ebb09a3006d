#pragma once
#include <stdexcept>
#include <string_view>
#include <vector>

namespace tessera::fuzz {

/// A guarantee does not hold. The message names the guarantee and the input.
class BrokenPromise : public std::logic_error {
  public:
    using std::logic_error::logic_error;
};

/// Throws BrokenPromise unless `kept`.
void promise(bool kept, std::string_view what);

/// Checks the message of an InputError or ResourceError: it begins with the file's name and is printable, whatever
/// bytes it quotes.
void promise_message(std::string_view message, std::string_view file);

/// A kind of input and the check of its guarantee: any bytes give either a result that satisfies its type's
/// documentation, or an InputError or ResourceError with a message. Throws BrokenPromise otherwise; any other exception
/// is also a failure.
struct FuzzTarget {
    std::string_view name;  ///< also the name of its folder in corpus/
    void (*check)(std::string_view bytes);
};

void check_obj(std::string_view bytes);
void check_ply(std::string_view bytes);
/// A map of any format. The corpus has PGM only, since libraries read EXR and PNG.
void check_map(std::string_view bytes);
void check_toml(std::string_view bytes);
void check_surface(std::string_view bytes);

const std::vector<FuzzTarget>& fuzz_targets();

}  // namespace tessera::fuzz
