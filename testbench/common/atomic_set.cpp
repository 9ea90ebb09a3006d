#include "testbench/common/atomic_set.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <set>
#include <system_error>

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

void AtomicSet::commit() {
    const Interruption::Delay delay;
    std::set<fs::path> folders;
    while (!files_.empty()) {
        const File& file = files_.front();
        if (::rename(file.from.c_str(), file.to.c_str()) != 0)
            throw InputError(fmt::format("{}: cannot write: {}", file.to.string(),
                                         std::generic_category().message(errno)));
        folders.insert(file.to.has_parent_path() ? file.to.parent_path() : fs::path("."));
        files_.erase(files_.begin());
    }
    for (const fs::path& folder : folders)
        synchronise(folder);
}

}  // namespace tessera
