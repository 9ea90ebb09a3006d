#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "testbench/common/interruption.h"

namespace tessera {

/// Files that appear under their names together, while others go away: the results of a command. While one lives,
/// every AtomicFile is written into a staging folder, ".tessera-<process>-<number>.part", until commit() renames them
/// all. Without commit(), after an error or an Interruption the staging folder goes and all is as it was.
///
/// The staging folder lies in the folder the files are for: so it is on the same file system, needs no other rights,
/// and follows links as they do; and several processes can write into one folder. Files are renamed one by one, never
/// the folder: what stands there under other names is not touched.
///
/// A process that is killed leaves its staging folder, which the next set in the folder removes. Killed within commit()
/// it can leave a part of the files as well: first of those taken away, with none new; then of the new ones. job.toml
/// appears first and goes last: a folder with any of a run's files has it. A file that is only replaced is never
/// missing: its name holds the old or the new version.
class AtomicSet {
  public:
    /// is_current: this is the set that AtomicFile joins. One at a time.
    explicit AtomicSet(bool is_current = true);
    ~AtomicSet();
    AtomicSet(const AtomicSet&) = delete;
    AtomicSet& operator=(const AtomicSet&) = delete;

    /// The one that AtomicFile joins, if any.
    static AtomicSet* current();

    /// A folder for the files, with those above it. Those that were not there go away again without commit(). Throws
    /// like open(); `key`: what names the folder in the message.
    void make_folder(const std::filesystem::path& folder, const std::string& key);

    /// Where the file is written that will be `path`.
    std::filesystem::path staged(const std::filesystem::path& path);

    /// Opens that file for writing. Errors, with `path` and the system's reason: ResourceError if disk, quota or memory
    /// ran out or the disk failed, else InputError (no such folder, not writable).
    int open(const std::filesystem::path& path);

    /// `path` is complete where it is staged: commit() will rename it.
    void add(const std::filesystem::path& path);

    /// A plain file that goes away when the others appear.
    void take_away(const std::filesystem::path& file);

    /// A folder that does so if nothing is left in it.
    void take_away_folder(const std::filesystem::path& folder);

    /// To be called once; an interrupt waits for it. Throws InputError, with the name, when a file can neither be
    /// renamed nor taken away: then all is as it was.
    void commit();

  private:
    std::filesystem::path in_staging(const char* what, const std::filesystem::path& path);
    void discard();

    std::map<std::filesystem::path, std::filesystem::path> staging_;  // of each folder
    std::vector<std::filesystem::path> made_;                         // innermost last
    std::vector<std::filesystem::path> files_, taken_away_, taken_away_folders_;
    Interruption::CleanUp clean_up_{[this] { discard(); }};  // the last: none of the above goes before it
};

/// Throws what an operation on a file came to: "PATH: WHAT: the system's reason".
[[noreturn]] void throw_file_error(const std::filesystem::path& path, const char* what, int error);

}  // namespace tessera
