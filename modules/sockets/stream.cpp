#include "modules/sockets/stream.h"

#include <stdexcept>
#include <string>
#include <systemc>

namespace tessera {

void stream_protocol_error(const char* socket, const char* rule, const CycleScheduler* clock) {
    std::string message = std::string(socket) + ": " + rule;
    if (clock != nullptr)
        message += ", in cycle " + std::to_string(clock->cycle());
    SC_REPORT_ERROR("tessera/protocol", message.c_str());
    throw std::logic_error(message);  // where SC_ERROR is configured not to throw
}

const sc_core::sc_object* module_behind(const sc_core::sc_interface* interface) {
    const auto* object = dynamic_cast<const sc_core::sc_object*>(interface);
    const bool is_socket = object != nullptr && dynamic_cast<const sc_core::sc_module*>(object) == nullptr;
    return is_socket ? object->get_parent_object() : object;
}

}  // namespace tessera
