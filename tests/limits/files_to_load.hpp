// What the programs of extreme cases read.
#pragma once

#include <string>

namespace breve::limits {

/// mesh.obj, sound.wav, lines.txt and push.txt, in this folder.
void write_files_to_load(const std::string& folder);

}  // namespace breve::limits
