// Reaction and diffusion of several fields at once: dc_i/dt = D_i Laplacian(c_i) + sum of rate * product of c_j^p_j, by
// explicit Euler. Any mass-action chemistry is such a sum; Gray and Scott's is one of five terms.
#pragma once

#include <array>
#include <cstdint>
#include <memory_resource>
#include <span>
#include <vector>

#include "runtime/patches/field.hpp"

namespace breve {

class Reaction {
 public:
  static constexpr std::size_t kMaxFields = 8;
  static constexpr int kMaxPower = 8;
  using Powers = std::array<std::uint8_t, kMaxFields>;  // by field; 0: it has no part

  /// @param fields  how many, 1 to kMaxFields
  /// @throws Error{Argument}
  Reaction(std::size_t fields, std::pmr::memory_resource* memory);

  std::size_t fields() const { return count_; }
  /// @param rate  in cells^2 / s. A step of dt is stable while 4 rate dt <= 1 in a plane, 6 rate dt <= 1 in space.
  void set_diffusion(std::size_t field, double rate);
  /// A term rate * product of c_j^powers_j of the change of one field.
  void add_term(std::size_t field, double rate, const Powers& powers);
  void clear_terms();

  /// One step of `dt` seconds of all fields, from their values before it. They must have the same sizes and lie in the
  /// memory given above; outside is 0, or the edges wrap. Throws Error{Argument} or std::bad_alloc, and nothing has
  /// changed then. No allocation after the first step.
  void step(std::span<Field* const> fields, double dt, bool periodic);

  void save(ByteWriter& out) const;
  static Reaction load(ByteReader& in);  // Error{Image}
  void hash(Hasher& hasher) const;

 private:
  struct Term {
    std::uint32_t field;
    double rate;
  };
  /// All terms of one product, so that it is worked out once.
  struct Group {
    Powers powers{};
    std::pmr::vector<Term> terms;
  };
  struct Row;
  void multiply(const Row& row);
  void step_field(std::size_t i, const Row& row, double dt);
  void step_row(const Row& row, double dt);
  void step_plane(std::span<Field* const> fields, double dt, bool periodic);
  void step_space(std::span<Field* const> fields, double dt, bool periodic);

  std::size_t count_;
  std::array<double, kMaxFields> diffusion_{}, constant_{}, linear_{};  // linear: in the field itself
  std::pmr::vector<Group> groups_;
  std::pmr::vector<std::pmr::vector<double>> scratch_;   // by field: a few rows, or in space all values after the step
  std::pmr::vector<std::pmr::vector<double>> products_;  // by group: of one row
  std::pmr::vector<double> zeros_;                       // a row outside
};

}  // namespace breve
