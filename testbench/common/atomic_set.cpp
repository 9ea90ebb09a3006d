#include "testbench/common/atomic_set.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <set>
#include <string>
#include <system_error>
#include <vector>

#include "testbench/common/error.h"

namespace tessera {
namespace {

namespace fs = std::filesystem;

AtomicSet* living = nullptr;

/// So that the names outlive a power cut too; file systems that cannot do this keep the files all the same.
void synchronise(const fs::path& folder) {
    const int handle = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (handle < 0)
        return;
    ::fsync(handle);
    ::close(handle);
}

/// Steps that are taken back, last first, unless all of them succeed.
class Steps {
  public:
    Steps() = default;
    Steps(const Steps&) = delete;
    Steps& operator=(const Steps&) = delete;
    ~Steps() {
        for (const fs::path& file : kept_)
            ::unlink(file.c_str());
    }

    /// `from` becomes `to`, of which a copy is kept if there is one.
    void replace(const fs::path& from, const fs::path& to) {
        fs::path copy = other_name(to);
        bool copied = ::link(to.c_str(), copy.c_str()) == 0;
        while (!copied && errno == EEXIST) {  // an earlier process of this number left it
            copy = other_name(to);
            copied = ::link(to.c_str(), copy.c_str()) == 0;
        }
        if (copied)
            kept_.push_back(copy);
        else if (errno != ENOENT && errno != EPERM && errno != EOPNOTSUPP)  // nothing there; no links here
            fail(to, errno);
        rename(from, to, to);
        if (copied)
            done_.back().copy = copy;
    }

    void put_aside(const fs::path& file) {
        const fs::path aside = other_name(file);
        rename(file, aside, file);
        kept_.push_back(aside);
    }

  private:
    struct Step {
        fs::path from, to, copy;
    };

    static fs::path other_name(const fs::path& file) {
        static unsigned number = 0;
        return fs::path(file).replace_filename(fmt::format(".tessera-{}-{}.old", ::getpid(), number++));
    }

    void rename(const fs::path& from, const fs::path& to, const fs::path& known_as) {
        if (::rename(from.c_str(), to.c_str()) != 0)
            fail(known_as, errno);
        done_.push_back({from, to, {}});
    }

    [[noreturn]] void fail(const fs::path& file, int error) {
        throw InputError(
            fmt::format("{}: cannot be replaced: {}; {}: make it and its folder writable, or write "
                        "to another folder",
                        file.string(), std::generic_category().message(error),
                        take_back() ? "all is as it was" : "not all could be put back as it was"));
    }

    bool take_back() {
        bool all = true;
        for (auto step = done_.rbegin(); step != done_.rend(); ++step) {
            all = ::rename(step->to.c_str(), step->from.c_str()) == 0 && all;
            if (!step->copy.empty())
                all = ::rename(step->copy.c_str(), step->to.c_str()) == 0 && all;
        }
        if (!all)
            kept_.clear();  // what could not be put back is not to be lost
        return all;
    }

    std::vector<Step> done_;
    std::vector<fs::path> kept_;
};

bool is_job(const fs::path& file) {
    return file.filename() == "job.toml";
}

fs::path folder_of(const fs::path& file) {
    return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

}  // namespace

AtomicSet::AtomicSet() {
    assert(living == nullptr);
    living = this;
}

AtomicSet::~AtomicSet() {
    living = nullptr;
    for (const File& file : files_)
        ::unlink(file.from.c_str());
}

AtomicSet* AtomicSet::current() {
    return living;
}

fs::path AtomicSet::waiting(const fs::path& path) const {
    const auto file =
        std::find_if(files_.begin(), files_.end(), [&](const File& each) { return each.to == path; });
    return file == files_.end() ? path : file->from;
}

void AtomicSet::add(const fs::path& from, const fs::path& to) {
    files_.push_back({from, to, std::make_unique<Unfinished>(from)});
}

void AtomicSet::take_away(const fs::path& file) {
    taken_away_.insert(file);
}

void AtomicSet::commit() {
    const Interruption::Delay delay;
    std::set<fs::path> folders;
    {
        Steps steps;
        for (const bool job : {false, true})
            for (const fs::path& file : taken_away_)
                if (is_job(file) == job)
                    steps.put_aside(file);
        for (const bool job : {true, false})
            for (const File& file : files_)
                if (is_job(file.to) == job)
                    steps.replace(file.from, file.to);
    }
    for (const File& file : files_)
        folders.insert(folder_of(file.to));
    for (const fs::path& file : taken_away_)
        folders.insert(folder_of(file));
    files_.clear();
    taken_away_.clear();
    for (const fs::path& folder : folders)
        synchronise(folder);
}

}  // namespace tessera
