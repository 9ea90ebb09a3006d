#pragma once
#include <string>

#include "modules/datapath/height_test.h"
#include "modules/datapath/parameters.h"
#include "modules/datapath/reads.h"
#include "modules/datapath/rectangle.h"

namespace tessera {

/// Entries of one request through a port.
struct EntryCount {
    unsigned least, most;
};
inline EntryCount entries_of_a_request(const datapath::HeightTestFunctions& test, unsigned port) {
    return port == 1 ? EntryCount{test.codes, test.codes}
                     : EntryCount{1, test.rectangles ? datapath::most_rectangle_entries : 1};
}

/// Whether a height test's reads() added what its class declares. Called for each edge.
inline bool as_declared(const datapath::HeightTestFunctions& test, const datapath::Reads& added,
                        const datapath::Registers& registers) {
    const unsigned port = added.last_port(), count = added.requests();
    if (count == 0)
        return added.entries() == 0 && port == 0 && (test.requests == 0 || test.may_read_nothing);
    if (count > datapath::Reads::most_requests || added.first(0) != 0 ||
        (port == 0 ? count != test.requests : port != 1 || count != 1 || !test.reads_codes(registers.formats)))
        return false;
    const EntryCount range = entries_of_a_request(test, port);
    bool so = true;
    for (unsigned k = 0; k < count; ++k)
        so = so && added.port(k) == port && added.count(k) >= range.least && added.count(k) <= range.most;
    return so;
}

/// In which way it did not.
inline std::string fault_of(const datapath::HeightTestFunctions& test, const datapath::Reads& added,
                            const datapath::Registers& registers) {
    const std::string its = "height test " + std::string(test.name) + ": reads() ";
    const unsigned port = added.last_port(), count = added.requests(), wanted = port == 0 ? test.requests : 1;
    if (port > 1 || (port == 1 && !test.reads_codes(registers.formats)))
        return its + "goes through port " + std::to_string(port) + ", but the last port is " +
               (test.reads_codes(registers.formats) ? "1" : "0: in this design no edge reads codes");
    if (count != wanted || count > datapath::Reads::most_requests)
        return its + "adds " + std::to_string(count) + " requests, but " +
               (count > datapath::Reads::most_requests
                    ? "at most " + std::to_string(datapath::Reads::most_requests) + " are kept"
                : port == 1 ? "codes are read in 1"
                            : "requests = " + std::to_string(test.requests) + " is declared") +
               (count == 0 ? ", and may_read_nothing = false" : "");
    if (count == 0 || added.first(0) != 0)
        return its + "adds an entry before the first request";
    const EntryCount range = entries_of_a_request(test, port);
    for (unsigned k = 0; k < count; ++k)
        if (added.count(k) < range.least || added.count(k) > range.most)
            return its + "adds " + std::to_string(added.count(k)) + " entries to a request, but with " +
                   (port == 1         ? "codes = " + std::to_string(test.codes)
                    : test.rectangles ? "rectangles = true"
                                      : "rectangles = false") +
                   " the range is " + std::to_string(range.least) + " to " + std::to_string(range.most);
    return its + "adds requests through both ports";
}

}  // namespace tessera
