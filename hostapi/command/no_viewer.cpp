// A build without SDL2.
#include "viewer.hpp"

namespace breve::command {

int view(const ViewOptions&, Output& output) {
  output.complain(
      "breve: this breve was built without SDL2 and opens no window.\n"
      "       `breve run --snapshot OUT.png` and `--movie OUT.mp4` draw into files.\n");
  return kWrongUsage;
}

}  // namespace breve::command
