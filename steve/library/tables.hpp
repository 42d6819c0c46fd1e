// The tables of native methods, one for each file of natives; library_natives() joins them.
#pragma once

#include <span>

#include "steve/machine/native.hpp"

namespace breve::steve {

std::span<const Native> object_natives();
std::span<const Native> obsolete_natives();
std::span<const Native> archive_natives();
std::span<const Native> control_natives();
std::span<const Native> view_natives();
std::span<const Native> camera_natives();
std::span<const Native> real_natives();
std::span<const Native> look_natives();
std::span<const Native> query_natives();
std::span<const Native> filter_natives();
std::span<const Native> mobile_natives();
std::span<const Native> shape_natives();
std::span<const Native> image_natives();
std::span<const Native> menu_natives();
std::span<const Native> drawing_natives();
std::span<const Native> data_natives();
std::span<const Native> matrix_natives();
std::span<const Native> vector_natives();
std::span<const Native> joint_natives();
std::span<const Native> spring_natives();
std::span<const Native> assembly_natives();
std::span<const Native> accuracy_natives();
std::span<const Native> terrain_natives();
std::span<const Native> mesh_natives();
std::span<const Native> patch_natives();
std::span<const Native> grid_natives();
std::span<const Native> cell_natives();
std::span<const Native> agent_natives();
std::span<const Native> reaction_natives();
std::span<const Native> push_natives();
std::span<const Native> push_program_natives();
std::span<const Native> sound_natives();
std::span<const Native> movie_natives();
std::span<const Native> network_natives();
std::span<const Native> neural_natives();
std::span<const Native> neural_training_natives();
std::span<const Native> evolution_natives();

}  // namespace breve::steve
