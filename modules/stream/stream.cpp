#include "modules/stream/stream.h"

#include <stdexcept>
#include <string>
#include <systemc>

namespace tessera {

void stream_protocol_error(const char* socket, const char* rule, const Clock* clock) {
    std::string message = std::string(socket) + ": " + rule;
    if (clock != nullptr)
        message += ", in cycle " + std::to_string(clock->cycle());
    SC_REPORT_ERROR("tessera/protocol", message.c_str());
    throw std::logic_error(message);  // where SC_ERROR was told not to throw
}

}  // namespace tessera
