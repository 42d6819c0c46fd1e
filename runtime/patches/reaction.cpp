// One pass over the rows: products of a row first, then each field's stencil with its own linear part folded into it,
// so that everything but the rows themselves stays in the nearest cache.
#include "runtime/patches/reaction.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runtime/base/error.hpp"

namespace breve {

namespace {

using Array = Eigen::Map<const Eigen::ArrayXd>;

constexpr std::size_t kKept = 3;  // rows of a plane: see step_plane

void need_finite(const char* what, double value) {
  if (!std::isfinite(value)) throw Error(ErrorCode::Argument, fmt::format("the {} must be finite", what));
}

}  // namespace

/// A row of all fields: the elements along the last axis, the rows that touch it, and where it goes.
struct Reaction::Row {
  Eigen::Index length;
  int beside;  // how many rows touch it: 0 on a line, 2 in a plane, 4 in space
  bool wraps;
  // By field; all are values before the step.
  std::array<const double*, kMaxFields> own;
  std::array<std::array<const double*, 4>, kMaxFields> near;
  std::array<double*, kMaxFields> to;
};

Reaction::Reaction(std::size_t fields, std::pmr::memory_resource* memory)
    : count_(fields), groups_(memory), scratch_(memory), products_(memory), zeros_(memory) {
  if (fields < 1 || fields > kMaxFields)
    throw Error(ErrorCode::Argument, fmt::format("a reaction of {} fields (1 to {} are possible)", fields, kMaxFields));
  scratch_.resize(fields);
}

void Reaction::set_diffusion(std::size_t field, double rate) {
  need_finite("diffusion rate", rate);
  if (rate < 0) throw Error(ErrorCode::Argument, fmt::format("the diffusion rate is {} (must be >= 0)", rate));
  diffusion_[field] = rate;
}

void Reaction::add_term(std::size_t field, double rate, const Powers& powers) {
  need_finite("rate of a term", rate);
  int degree = 0;
  for (const std::uint8_t power : powers) {
    if (power > kMaxPower) throw Error(ErrorCode::Argument, fmt::format("the power {} (at most {})", power, kMaxPower));
    degree += power;
  }
  if (degree == 0) {
    constant_[field] += rate;
  } else if (degree == 1 && powers[field] == 1) {
    linear_[field] += rate;
  } else {
    auto group = std::find_if(groups_.begin(), groups_.end(), [&](const Group& g) { return g.powers == powers; });
    if (group == groups_.end()) {
      groups_.push_back({powers, std::pmr::vector<Term>(groups_.get_allocator())});
      group = groups_.end() - 1;
    }
    group->terms.push_back({static_cast<std::uint32_t>(field), rate});
  }
}

void Reaction::clear_terms() {
  constant_.fill(0);
  linear_.fill(0);
  groups_.clear();
}

/// The products of the terms, for one row.
void Reaction::multiply(const Row& row) {
  const Eigen::Index n = row.length;
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    Eigen::Map<Eigen::ArrayXd> product(products_[g].data(), n);
    bool first = true;
    for (std::size_t i = 0; i < count_; ++i) {
      const Array c(row.own[i], n);
      for (int left = groups_[g].powers[i]; left > 0;) {
        const bool twice = left > 1;
        left -= twice ? 2 : 1;
        if (first && twice)
          product = c * c;
        else if (first)
          product = c;
        else if (twice)
          product *= c * c;
        else
          product *= c;
        first = false;
      }
    }
  }
}

void Reaction::step_row(const Row& row, double dt) {
  multiply(row);
  for (std::size_t i = 0; i < count_; ++i) step_field(i, row, dt);
}

void Reaction::step_field(std::size_t i, const Row& row, double dt) {
  const Eigen::Index n = row.length;
  const double* const c = row.own[i];
  double* const to = row.to[i];
  const std::array<const double*, 4>& near = row.near[i];
  const double beside = dt * diffusion_[i];
  const double own = 1 + dt * linear_[i] - (2 + row.beside) * beside;
  const double flow = dt * constant_[i];
  // The first product of this field goes along with the stencil.
  const double* product = nullptr;
  double rate = 0;
  for (std::size_t g = 0; g < groups_.size() && !product; ++g) {
    for (const Term& term : groups_[g].terms) {
      if (term.field != i || product) continue;
      product = products_[g].data();
      rate = dt * term.rate;
    }
  }
  const auto one = [&](Eigen::Index j, double before, double after) {
    double sum = before + after;
    for (int r = 0; r < row.beside; ++r) sum += near[static_cast<std::size_t>(r)][j];
    to[j] = own * c[j] + beside * sum + flow + (product ? rate * product[j] : 0.0);
  };
  const double low = row.wraps ? c[n - 1] : 0.0, high = row.wraps ? c[0] : 0.0;
  one(0, low, n > 1 ? c[1] : high);
  if (n > 1) one(n - 1, c[n - 2], high);
  if (const Eigen::Index m = n - 2; m > 0) {
    Eigen::Map<Eigen::ArrayXd> out(to + 1, m);
    const auto line = [&](const double* values) { return Array(values, m); };
    const auto along = line(c) + line(c + 2);
    const auto write = [&](const auto& sum) {
      if (product)
        out = own * line(c + 1) + beside * sum + flow + rate * line(product + 1);
      else
        out = own * line(c + 1) + beside * sum + flow;
    };
    if (row.beside == 0) write(along);
    if (row.beside == 2) write(along + line(near[0] + 1) + line(near[1] + 1));
    if (row.beside == 4) write(along + line(near[0] + 1) + line(near[1] + 1) + line(near[2] + 1) + line(near[3] + 1));
  }
  bool skipped = false;
  Eigen::Map<Eigen::ArrayXd> out(to, n);
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    for (const Term& term : groups_[g].terms) {
      if (term.field != i) continue;
      if (skipped) out += (dt * term.rate) * Array(products_[g].data(), n);
      skipped = true;
    }
  }
}

void Reaction::step(std::span<Field* const> fields, double dt, bool periodic) {
  need_finite("time step of a reaction", dt);
  if (fields.size() != count_)
    throw Error(ErrorCode::Argument, fmt::format("{} fields for a reaction of {}", fields.size(), count_));
  const Field& shape = *fields[0];
  for (std::size_t i = 0; i < count_; ++i) {
    if (!fields[i]->same_size(shape))
      throw Error(ErrorCode::Argument, "the matrices of a reaction must have the same sizes");
    for (std::size_t j = 0; j < i; ++j)
      if (fields[i] == fields[j]) throw Error(ErrorCode::Argument, "a reaction names one matrix twice");
  }
  // The elements of one layer in space lie as those of a plane.
  const auto n = static_cast<std::size_t>(shape.spans() == 1   ? shape.nx()
                                          : shape.spans() == 2 ? shape.ny()
                                                               : shape.nz());
  products_.resize(groups_.size());
  for (auto& product : products_) product.resize(n);
  zeros_.assign(n, 0.0);
  const std::size_t room = shape.spans() == 3 ? shape.size() : kKept * n;
  for (auto& scratch : scratch_) scratch.resize(room);
  if (shape.spans() == 3)
    step_space(fields, dt, periodic);
  else
    step_plane(fields, dt, periodic);
}

/// A line or a plane, in place: the values before the step are kept of the row at work, the one before it and the
/// first.
void Reaction::step_plane(std::span<Field* const> fields, double dt, bool periodic) {
  const bool line = fields[0]->dimensions() == 1;
  const int rows = line ? 1 : fields[0]->nx();
  const int length = line ? fields[0]->nx() : fields[0]->ny();
  Row row{length, line ? 0 : 2, periodic, {}, {}, {}};
  const auto n = static_cast<std::size_t>(length);
  for (int x = 0; x < rows; ++x) {
    for (std::size_t i = 0; i < count_; ++i) {
      double* const kept = scratch_[i].data();
      double* const now = kept + (x % 2 == 0 ? 0 : n);
      double* const before = kept + (x % 2 == 0 ? n : 0);
      double* const first = kept + 2 * n;
      double* const values = fields[i]->data();
      row.to[i] = values + static_cast<std::size_t>(x) * n;
      std::copy_n(row.to[i], n, now);
      if (x == 0) std::copy_n(now, n, first);
      row.own[i] = now;
      const double* const last = rows == 1 ? now : values + static_cast<std::size_t>(rows - 1) * n;
      const double* const above = x > 0 ? before : periodic ? last : zeros_.data();
      const double* const below = x + 1 < rows ? row.to[i] + n : periodic ? first : zeros_.data();
      row.near[i] = {above, below, nullptr, nullptr};
    }
    step_row(row, dt);
  }
}

/// In space, into other arrays, which then take the place of the old ones.
void Reaction::step_space(std::span<Field* const> fields, double dt, bool periodic) {
  const int nx = fields[0]->nx(), ny = fields[0]->ny(), nz = fields[0]->nz();
  Row row{nz, 4, periodic, {}, {}, {}};
  const auto start = [&](int x, int y) -> std::ptrdiff_t {
    if (periodic) {
      x = (x + nx) % nx;
      y = (y + ny) % ny;
    } else if (x < 0 || x >= nx || y < 0 || y >= ny) {
      return -1;
    }
    return (static_cast<std::ptrdiff_t>(x) * ny + y) * nz;
  };
  for (int x = 0; x < nx; ++x) {
    for (int y = 0; y < ny; ++y) {
      const std::array<std::ptrdiff_t, 4> near{start(x - 1, y), start(x + 1, y), start(x, y - 1), start(x, y + 1)};
      for (std::size_t i = 0; i < count_; ++i) {
        const double* const values = fields[i]->data();
        row.own[i] = values + start(x, y);
        row.to[i] = scratch_[i].data() + start(x, y);
        for (std::size_t r = 0; r < near.size(); ++r) row.near[i][r] = near[r] < 0 ? zeros_.data() : values + near[r];
      }
      step_row(row, dt);
    }
  }
  for (std::size_t i = 0; i < count_; ++i) fields[i]->swap_values(scratch_[i]);
}

void Reaction::save(ByteWriter& out) const {
  out.put(static_cast<std::uint32_t>(count_));
  for (std::size_t i = 0; i < count_; ++i) {
    out.put(diffusion_[i]);
    out.put(constant_[i]);
    out.put(linear_[i]);
  }
  out.put(static_cast<std::uint64_t>(groups_.size()));
  for (const Group& group : groups_) {
    out.raw(group.powers.data(), group.powers.size());
    out.put(static_cast<std::uint64_t>(group.terms.size()));
    for (const Term& term : group.terms) {
      out.put(term.field);
      out.put(term.rate);
    }
  }
}

Reaction Reaction::load(ByteReader& in) {
  const auto count = in.get<std::uint32_t>();
  if (count < 1 || count > kMaxFields) ByteReader::fail();
  Reaction made(count, in.memory());
  for (std::size_t i = 0; i < count; ++i) {
    made.diffusion_[i] = in.get<double>();
    made.constant_[i] = in.get<double>();
    made.linear_[i] = in.get<double>();
  }
  for (std::size_t left = in.get_count(kMaxFields); left > 0; --left) {
    Powers powers{};
    in.raw(powers.data(), powers.size());
    for (const std::uint8_t power : powers)
      if (power > kMaxPower) ByteReader::fail();
    Group group{powers, std::pmr::vector<Term>(in.memory())};
    for (std::size_t terms = in.get_count(sizeof(double)); terms > 0; --terms) {
      const auto field = in.get<std::uint32_t>();
      if (field >= count) ByteReader::fail();
      group.terms.push_back({field, in.get<double>()});
    }
    made.groups_.push_back(std::move(group));
  }
  return made;
}

void Reaction::hash(Hasher& hasher) const {
  for (std::size_t i = 0; i < count_; ++i) {
    hasher.add(diffusion_[i]);
    hasher.add(constant_[i]);
    hasher.add(linear_[i]);
  }
  for (const Group& group : groups_) {
    hasher.add(std::string_view(reinterpret_cast<const char*>(group.powers.data()), group.powers.size()));
    for (const Term& term : group.terms) {
      hasher.add(static_cast<std::uint64_t>(term.field));
      hasher.add(term.rate);
    }
  }
}

}  // namespace breve
