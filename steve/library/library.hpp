// The class library as the compiler and the machine see it: embedded files, native methods, kinds of native data.
#pragma once

#include <span>
#include <string_view>

#include "runtime/world/world.hpp"
#include "steve/compile/program.hpp"
#include "steve/machine/native.hpp"

namespace breve::steve {

/// Every file of the embedded library, in alphabetical order.
std::span<const LibraryFile> library_files();

/// Classes that the documents name and that this version does not have, aliases too.
std::span<const std::string_view> later_classes();
bool is_later_class(std::string_view name_or_alias);
/// A file of the library that has another name than its classes, and comes with a later version.
bool is_later_file(std::string_view name);

/// Teach a world to load the native data of library objects from snapshots. Once per world, before the first load.
void register_resource_kinds(World& world);

/// Native data of that kind out of an image. Error{Image} if there is no such kind or the image is damaged.
std::unique_ptr<Resource> load_resource(std::string_view kind, ByteReader& in);

}  // namespace breve::steve
