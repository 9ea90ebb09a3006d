#pragma once
#include <systemc>

namespace tessera {

/// What Get Triangle sees of the Triangle Queue's level.
class TriangleQueueLevel : public virtual sc_core::sc_interface {
  public:
    /// True while fewer triangles than the watermark wait.
    virtual bool takes_host_triangles() const = 0;
    /// Functional mode, asked for by a host that cannot send: notified when it may.
    virtual const sc_core::sc_event& host_may_send() = 0;
};

}  // namespace tessera
