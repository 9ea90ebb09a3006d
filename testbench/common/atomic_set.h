#pragma once
#include <filesystem>
#include <memory>
#include <set>
#include <vector>

#include "testbench/common/interruption.h"

namespace tessera {

/// Files that appear under their names together, while others go away: while one lives, each AtomicFile that is
/// committed waits here, whole and on the disk, until commit() renames all of them; an interrupt waits for
/// that. Without commit() none appears, and what stood under the names stays. One at a time.
///
/// A process that is killed within commit() can leave a part: of the files taken away before any is new, then
/// of the new ones. In each folder job.toml appears first and goes last: a folder with any of a run's files
/// has it.
class AtomicSet {
  public:
    AtomicSet();
    ~AtomicSet();
    AtomicSet(const AtomicSet&) = delete;
    AtomicSet& operator=(const AtomicSet&) = delete;

    /// Where the file waits that will be `path`.
    std::filesystem::path waiting(const std::filesystem::path& path) const;

    /// Takes a file into the set that is complete at `from`.
    void add(const std::filesystem::path& from, const std::filesystem::path& to);

    /// A plain file that goes away when the others appear.
    void take_away(const std::filesystem::path& file);

    /// To be called once. Throws InputError, with the name, when a file can neither be renamed nor taken away: then all
    /// is as it was.
    void commit();

    /// The one that lives, if any.
    static AtomicSet* current();

  private:
    struct File {
        std::filesystem::path from, to;
        std::unique_ptr<Unfinished> unfinished;
    };
    std::vector<File> files_;
    std::set<std::filesystem::path> taken_away_;
};

}  // namespace tessera
