#pragma once
#include <stdexcept>
#include <string_view>
#include <vector>

namespace tessera::fuzz {

/// What must never happen, happened: the message says what, of which input.
class BrokenPromise : public std::logic_error {
  public:
    using std::logic_error::logic_error;
};

/// Throws BrokenPromise.
void promise(bool kept, std::string_view what);

/// The words of an InputError or ResourceError: they begin with the file's name and can be printed, whatever bytes they
/// quote.
void promise_message(std::string_view message, std::string_view file);

/// One kind of input and all that is promised of whatever bytes come as such: a result that holds what its
/// type says, or an InputError or ResourceError in words. Throws BrokenPromise where that fails; any other
/// exception is a failure as well.
struct FuzzTarget {
    std::string_view name;  ///< also of its folder in corpus/
    void (*check)(std::string_view bytes);
};

void check_patches(std::string_view bytes);
void check_ply(std::string_view bytes);
/// A map of any format. The corpus has PGM only: EXR and PNG are read by libraries.
void check_map(std::string_view bytes);
void check_toml(std::string_view bytes);
void check_surface(std::string_view bytes);
void check_datapath(std::string_view bytes);

const std::vector<FuzzTarget>& fuzz_targets();

}  // namespace tessera::fuzz
