// Camera, lights, backdrop and overlay text as scripts set them: state only, read by whoever draws.
#pragma once

namespace breve {

struct ViewState {};

}  // namespace breve
