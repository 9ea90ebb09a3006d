#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "testbench/common/interruption.h"

namespace tessera {

/// A set of files that become visible together while others are removed: the results of a command. While a set exists,
/// every AtomicFile is written into a staging folder, ".tessera-<process>-<number>.part", until commit() renames all
/// files. Without commit(), after an error or an Interruption, the staging folder is removed and nothing has changed.
///
/// The staging folder is inside the target folder: it is on the same file system, needs no other permissions, follows
/// the same links, and several processes can write into one folder. Files are renamed one by one, never the folder, so
/// files with other names are not touched.
///
/// A killed process leaves its staging folder, which the next set in the folder removes. A process killed within
/// commit() may also leave a part of the files: first some of the old files without new ones, then some of the new
/// ones. job.toml appears first and is removed last: a folder with any of a run's files has it. A file that is only
/// replaced is never missing: its name refers to the old or the new version.
class AtomicSet {
  public:
    /// is_current: AtomicFile joins this set. At most one at a time.
    explicit AtomicSet(bool is_current = true);
    ~AtomicSet();
    AtomicSet(const AtomicSet&) = delete;
    AtomicSet& operator=(const AtomicSet&) = delete;

    /// The set that AtomicFile joins, if any.
    static AtomicSet* current();

    /// Creates a folder for the files, and its parents. Without commit() those created are removed again. Throws like
    /// open(); `key`: the setting named in the message.
    void make_folder(const std::filesystem::path& folder, const std::string& key);

    /// The path in the staging folder at which `path` is to be written.
    std::filesystem::path staged(const std::filesystem::path& path);

    /// Opens that file for writing. Errors, with `path` and the system's reason: ResourceError if disk, quota or memory
    /// ran out or the disk failed, else InputError (no such folder, not writable).
    int open(const std::filesystem::path& path);

    /// Marks the staged file of `path` as complete: commit() will rename it.
    void add(const std::filesystem::path& path);

    /// Removes a regular file when the others appear.
    void take_away(const std::filesystem::path& file);

    /// Call once; signals wait until it returns. Throws InputError, with the name, if a file can be neither renamed nor
    /// removed: then nothing has changed.
    void commit();

  private:
    std::filesystem::path in_staging(const char* what, const std::filesystem::path& path);
    void discard();

    std::map<std::filesystem::path, std::filesystem::path> staging_;  // by target folder
    std::vector<std::filesystem::path> made_;                         // innermost last
    std::vector<std::filesystem::path> files_, taken_away_;
    Interruption::CleanUp clean_up_{[this] { discard(); }};  // last member: destroyed before all of the above
};

/// Throws the error of a file operation: "PATH: WHAT: the system's reason".
[[noreturn]] void throw_file_error(const std::filesystem::path& path, const char* what, int error);

}  // namespace tessera
