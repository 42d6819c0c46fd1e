// A mesh, a sound and two texts.
#include "files_to_load.hpp"

#include <cmath>
#include <cstdint>
#include <fstream>

namespace breve::limits {

namespace {

/// A sphere of 1,800 triangles.
void write_mesh(const std::string& name) {
  constexpr int kRows = 30;
  std::ofstream file(name);
  for (int row = 0; row <= kRows; ++row)
    for (int column = 0; column < kRows; ++column) {
      const double down = M_PI * row / kRows, around = 2 * M_PI * column / kRows;
      file << "v " << std::sin(down) * std::cos(around) << " " << std::cos(down) << " "
           << std::sin(down) * std::sin(around) << "\n";
    }
  for (int row = 0; row < kRows; ++row)
    for (int column = 0; column < kRows; ++column) {
      const int next = (column + 1) % kRows, here = row * kRows + 1, below = here + kRows;
      file << "f " << here + column << " " << below + column << " " << below + next << "\n";
      file << "f " << here + column << " " << below + next << " " << here + next << "\n";
    }
}
/// Ten seconds of silence, 16 bits, mono.
void write_sound(const std::string& name) {
  constexpr std::uint32_t kBytes = 882000;
  std::ofstream file(name, std::ios::binary);
  const auto number = [&](auto value) { file.write(reinterpret_cast<const char*>(&value), sizeof value); };
  file << "RIFF", number(kBytes + 36), file << "WAVEfmt ", number(std::uint32_t{16}), number(std::uint16_t{1});
  number(std::uint16_t{1}), number(std::uint32_t{44100}), number(std::uint32_t{88200}), number(std::uint16_t{2});
  number(std::uint16_t{16}), file << "data", number(kBytes), file << std::string(kBytes, '\0');
}

}  // namespace

void write_files_to_load(const std::string& folder) {
  std::ofstream(folder + "/push.txt") << "instruction INTEGER.+\n";
  std::ofstream lines(folder + "/lines.txt");
  for (int i = 0; i < 20000; ++i) lines << i << " a line, of some words\n";
  write_mesh(folder + "/mesh.obj");
  write_sound(folder + "/sound.wav");
}

}  // namespace breve::limits
