// Every native method of the class library, from the tables of the files that define them.
#include <array>

#include "steve/library/library.hpp"
#include "steve/library/tables.hpp"

namespace breve::steve {

namespace {

constexpr std::size_t kMaxNatives = 1024;

/// One array made of all tables. Filled once, then constant: a table of addresses, the same for every world.
struct Joined {
  std::array<Native, kMaxNatives> natives{};
  std::size_t count = 0;

  Joined() {
    for (std::span<const Native> table :
         {object_natives(),          obsolete_natives(), archive_natives(), control_natives(),      view_natives(),
          camera_natives(),          real_natives(),     look_natives(),    mobile_natives(),       shape_natives(),
          image_natives(),           menu_natives(),     drawing_natives(), data_natives(),         matrix_natives(),
          vector_natives(),          joint_natives(),    spring_natives(),  assembly_natives(),     accuracy_natives(),
          terrain_natives(),         mesh_natives(),     patch_natives(),   grid_natives(),         cell_natives(),
          agent_natives(),           reaction_natives(), push_natives(),    push_program_natives(), query_natives(),
          filter_natives(),          sound_natives(),    movie_natives(),   network_natives(),      neural_natives(),
          neural_training_natives(), evolution_natives()})
      for (const Native& native : table) natives.at(count++) = native;
  }
};

}  // namespace

std::span<const Native> library_natives() {
  static const Joined joined;
  return {joined.natives.data(), joined.count};
}

}  // namespace breve::steve
