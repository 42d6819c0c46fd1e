// The class library as its users see it: embedded files, native methods, kinds of native data.
#pragma once

#include <span>
#include <string_view>

#include "runtime/world/world.hpp"
#include "steve/code/library_source.hpp"

namespace breve::steve {

/// Every file of the embedded library, in alphabetical order.
std::span<const LibraryFile> library_files();

/// Every native method of the class library.
std::span<const Native> library_natives();

/// All that programs are compiled with: these, and the functions of the language.
const LibrarySource& library_source();

/// Teach a world to load the native data of library objects from snapshots. Once per world, before the first load.
void register_resource_kinds(World& world);

/// Native data of that kind out of an image. Error{Image} if there is no such kind or the image is damaged.
std::unique_ptr<Resource> load_resource(std::string_view kind, ByteReader& in);

}  // namespace breve::steve
