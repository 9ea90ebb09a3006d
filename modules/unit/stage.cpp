#include "modules/unit/stage.h"

#include "modules/unit/stage_steps.h"

namespace tessera {

template class Stage<Work>;

}  // namespace tessera
