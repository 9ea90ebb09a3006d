#pragma once
#include <cstddef>
#include <cstdint>

namespace tessera {

/// The state of a unit in a cycle: exactly one of these, so that their cycles add up to those of the run.
///
///   blocked             a finished item waits for its consumer to accept it
///   busy                not blocked, and an item with all its operands is being processed
///   waiting for memory  neither, and an item's table entries are outstanding
///   starved             nothing to work on, or an operand is missing (the View Test's screen positions, the other
///                       branch in Pass or Tessellate)
///
/// (Decision: a unit that is blocked while it still works counts as blocked, since users look for blocked units; one
/// that computes during its next reads counts as busy.)
enum class State : std::uint8_t { starved, busy, waiting_for_memory, blocked };
constexpr std::size_t states = 4;

}  // namespace tessera
