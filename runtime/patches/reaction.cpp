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

void need_finite(const char* what, double value) {
  if (!std::isfinite(value)) throw Error(ErrorCode::Argument, fmt::format("the {} must be finite", what));
}

}  // namespace

/// A row of all fields: the elements along the last axis, and the rows beside it.
struct Reaction::Row {
  std::size_t at;  // of its first element
  Eigen::Index length;
  int beside;                                    // rows that touch it: 0 on a line, 2 in a plane, 4 in space
  std::array<std::ptrdiff_t, 4> rows;            // where these begin; negative: outside
  std::array<const double*, kMaxFields> values;  // by field: all of it
  bool wraps;
};

Reaction::Reaction(std::size_t fields, std::pmr::memory_resource* memory)
    : count_(fields), groups_(memory), fresh_(memory), products_(memory), zeros_(memory) {
  if (fields < 1 || fields > kMaxFields)
    throw Error(ErrorCode::Argument, fmt::format("a reaction of {} fields (1 to {} are possible)", fields, kMaxFields));
  fresh_.resize(fields);
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

void Reaction::step_row(const Row& row, double dt) {
  const Eigen::Index n = row.length;
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    Eigen::Map<Eigen::ArrayXd> product(products_[g].data(), n);
    bool first = true;
    for (std::size_t i = 0; i < count_; ++i) {
      const Array c(row.values[i] + row.at, n);
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
  for (std::size_t i = 0; i < count_; ++i) {
    const double* const c = row.values[i] + row.at;
    double* const to = fresh_[i].data() + row.at;
    const double beside = dt * diffusion_[i];
    const double own = 1 + dt * linear_[i] - (2 + row.beside) * beside;
    const double flow = dt * constant_[i];
    std::array<const double*, 4> near{};
    for (int r = 0; r < row.beside; ++r) {
      const std::ptrdiff_t start = row.rows[static_cast<std::size_t>(r)];
      near[static_cast<std::size_t>(r)] = start < 0 ? zeros_.data() : row.values[i] + start;
    }
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
  const int dimensions = shape.dimensions();
  const int length = dimensions == 1 ? shape.nx() : dimensions == 2 ? shape.ny() : shape.nz();
  const auto n = static_cast<std::size_t>(length);
  for (auto& fresh : fresh_) fresh.resize(shape.size());
  products_.resize(groups_.size());
  for (auto& product : products_) product.resize(n);
  zeros_.assign(n, 0.0);

  Row row{};
  row.length = length;
  row.beside = 2 * (dimensions - 1);
  row.wraps = periodic;
  for (std::size_t i = 0; i < count_; ++i) row.values[i] = fields[i]->values().data();
  // Rows are counted along x, and in space along y within it.
  const int outer = dimensions == 1 ? 1 : shape.nx(), inner = dimensions == 3 ? shape.ny() : 1;
  const auto start = [&](int x, int y) -> std::ptrdiff_t {
    if (periodic) {
      x = (x + outer) % outer;
      y = (y + inner) % inner;
    } else if (x < 0 || x >= outer || y < 0 || y >= inner) {
      return -1;
    }
    return (static_cast<std::ptrdiff_t>(x) * inner + y) * length;
  };
  for (int x = 0; x < outer; ++x) {
    for (int y = 0; y < inner; ++y) {
      row.at = static_cast<std::size_t>(start(x, y));
      row.rows = {start(x - 1, y), start(x + 1, y), start(x, y - 1), start(x, y + 1)};
      step_row(row, dt);
    }
  }
  for (std::size_t i = 0; i < count_; ++i) fields[i]->swap_values(fresh_[i]);
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
