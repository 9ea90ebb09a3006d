#include "testbench/job/document_keys.h"

#include <fmt/format.h>

#include "testbench/job/job_keys.h"
#include "testbench/job/toml_text.h"

namespace tessera {

std::string document_keys() {
    std::string out;
    for (const KeyTable& table : job_tables()) {
        out += fmt::format(
            "{}### {}\n\n{}\n\n| key | default | range | unit | meaning |\n| --- | --- | --- | --- | --- |\n",
            out.empty() ? "" : "\n", table.name.empty() ? "Top level" : '`' + table.name + '`', table.description);
        for (const Key& key : table.keys) {
            out += fmt::format("| `{}` | `{}` | {} | {} | {} |\n", key.name, toml_value(default_of(key)),
                               range_text(key), key.unit, key.description);
        }
    }
    return out;
}

}  // namespace tessera
