// Reaction and diffusion against closed forms: the discrete heat kernel, mass balance, a plain loop.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "runtime/base/error.hpp"
#include "runtime/base/random.hpp"
#include "runtime/patches/reaction.hpp"

namespace breve {
namespace {

std::pmr::memory_resource* memory() { return std::pmr::get_default_resource(); }

void step(Reaction& reaction, std::vector<Field*> fields, double dt, bool periodic) {
  reaction.step(fields, dt, periodic);
}

Field random_field(int nx, int ny, int nz, std::uint64_t seed) {
  Field field = nz > 1 ? Field::space(nx, ny, nz) : ny > 1 ? Field::plane(nx, ny) : Field::line(nx);
  Random random(seed);
  for (int x = 0; x < nx; ++x)
    for (int y = 0; y < ny; ++y)
      for (int z = 0; z < nz; ++z) field.set(x, y, z, random.uniform());
  return field;
}

TEST(Reaction, PeriodicDiffusionAloneKeepsTheMass) {
  constexpr double kBound = 1e-12;  // of the whole, as the issue states
  Field u = random_field(64, 64, 1, 1), v = random_field(64, 64, 1, 2);
  const double mass_u = u.absolute_sum(), mass_v = v.absolute_sum();
  Reaction reaction(2, memory());
  reaction.set_diffusion(0, 0.2);
  reaction.set_diffusion(1, 0.1);
  for (int i = 0; i < 1000; ++i) step(reaction, {&u, &v}, 1, true);
  EXPECT_NEAR(u.absolute_sum() / mass_u, 1, kBound);
  EXPECT_NEAR(v.absolute_sum() / mass_v, 1, kBound);
}

TEST(Reaction, OneLayerInSpaceReactsAsAPlane) {
  for (const bool periodic : {false, true}) {
    Field plane = random_field(11, 8, 1, 5), layer = Field::space(11, 8, 1);
    for (int x = 0; x < 11; ++x)
      for (int y = 0; y < 8; ++y) layer.set(x, y, 0, plane.get(x, y));
    Reaction reaction(1, memory());
    reaction.set_diffusion(0, 0.2);
    reaction.add_term(0, 0.1, {2});
    for (int i = 0; i < 20; ++i) {
      step(reaction, {&plane}, 0.5, periodic);
      step(reaction, {&layer}, 0.5, periodic);
    }
    EXPECT_TRUE((plane.values() == layer.values()).all());
  }
}

TEST(Reaction, GrayScottTurnsOneIntoTheOtherWithoutFeedAndKill) {
  constexpr double kBound = 1e-12;
  Field u = random_field(32, 32, 1, 3), v = random_field(32, 32, 1, 4);
  const double mass = u.absolute_sum() + v.absolute_sum(), first = u.absolute_sum();
  Reaction reaction(2, memory());
  reaction.set_diffusion(0, 0.2);
  reaction.set_diffusion(1, 0.1);
  reaction.add_term(0, -1, {1, 2});
  reaction.add_term(1, 1, {1, 2});
  for (int i = 0; i < 200; ++i) step(reaction, {&u, &v}, 0.5, true);
  EXPECT_LT(u.absolute_sum(), 0.9 * first);
  EXPECT_NEAR((u.absolute_sum() + v.absolute_sum()) / mass, 1, kBound);
}

/// One step of c += a Laplacian(c) on a ring multiplies wave k by 1 - 4 a sin^2(pi k / n): the kernel after `steps`
/// steps by its finite Fourier sum.
double ring_kernel(int n, double a, int steps, int x) {
  double sum = 0;
  for (int k = 0; k < n; ++k) {
    const double wave = std::numbers::pi * k / n;
    sum += std::pow(1 - 4 * a * std::sin(wave) * std::sin(wave), steps) * std::cos(2 * wave * x);
  }
  return sum / n;
}

TEST(Reaction, APointOnALineBecomesTheDiscreteHeatKernel) {
  constexpr double kRounding = 1e-13;
  constexpr int kSize = 25, kSteps = 60;
  Field c = Field::line(kSize);
  c.set(0, 0, 0, 1);
  Reaction reaction(1, memory());
  reaction.set_diffusion(0, 0.25);
  for (int i = 0; i < kSteps; ++i) step(reaction, {&c}, 0.5, true);
  for (int x = 0; x < kSize; ++x) EXPECT_NEAR(c.get(x), ring_kernel(kSize, 0.125, kSteps, x), kRounding) << x;
}

TEST(Reaction, APointInThePlaneBecomesTheDiscreteHeatKernel) {
  constexpr double kRounding = 1e-13, kRate = 0.125;
  constexpr int kNx = 16, kNy = 9, kSteps = 40;
  Field c = Field::plane(kNx, kNy);
  c.set(3, 4, 0, 1);
  Reaction reaction(1, memory());
  reaction.set_diffusion(0, kRate);
  for (int i = 0; i < kSteps; ++i) step(reaction, {&c}, 1, true);
  for (int x = 0; x < kNx; ++x) {
    for (int y = 0; y < kNy; ++y) {
      double sum = 0;
      for (int k = 0; k < kNx; ++k) {
        for (int l = 0; l < kNy; ++l) {
          const double p = std::numbers::pi * k / kNx, q = std::numbers::pi * l / kNy;
          const double factor = 1 - 4 * kRate * (std::sin(p) * std::sin(p) + std::sin(q) * std::sin(q));
          sum += std::pow(factor, kSteps) * std::cos(2 * p * (x - 3)) * std::cos(2 * q * (y - 4));
        }
      }
      EXPECT_NEAR(c.get(x, y), sum / (kNx * kNy), kRounding) << x << ", " << y;
    }
  }
}

/// The equation element by element, with every neighbour looked up.
double changed(const std::vector<Field>& c, std::size_t i, double diffusion, const std::vector<double>& rates,
               const std::vector<Reaction::Powers>& powers, double dt, bool periodic, int x, int y, int z) {
  const Field& f = c[i];
  const auto at = [&](int a, int b, int e) {
    if (periodic) {
      a = (a + f.nx()) % f.nx();
      b = (b + f.ny()) % f.ny();
      e = (e + f.nz()) % f.nz();
    } else if (a < 0 || a >= f.nx() || b < 0 || b >= f.ny() || e < 0 || e >= f.nz()) {
      return 0.0;
    }
    return f.get(a, b, e);
  };
  double near = at(x - 1, y, z) + at(x + 1, y, z) - 2 * f.get(x, y, z);
  if (f.dimensions() > 1) near += at(x, y - 1, z) + at(x, y + 1, z) - 2 * f.get(x, y, z);
  if (f.dimensions() > 2) near += at(x, y, z - 1) + at(x, y, z + 1) - 2 * f.get(x, y, z);
  double sum = diffusion * near;
  for (std::size_t t = 0; t < rates.size(); ++t) {
    double product = rates[t];
    for (std::size_t j = 0; j < c.size(); ++j) product *= std::pow(c[j].get(x, y, z), powers[t][j]);
    sum += product;
  }
  return f.get(x, y, z) + dt * sum;
}

TEST(Reaction, AgreesWithTheEquationElementByElement) {
  constexpr double kRounding = 1e-14;
  for (const bool periodic : {false, true}) {
    for (const Eigen::Array3i& size :
         {Eigen::Array3i(7, 1, 1), Eigen::Array3i(5, 6, 1), Eigen::Array3i(4, 3, 5), Eigen::Array3i(1, 1, 1),
          Eigen::Array3i(2, 2, 2), Eigen::Array3i(1, 6, 1), Eigen::Array3i(2, 5, 1)}) {
      std::vector<Field> c;
      for (std::uint64_t i = 0; i < 3; ++i) c.push_back(random_field(size[0], size[1], size[2], i));
      const std::vector<double> diffusion{0.1, 0, 0.05};
      const std::vector<std::vector<double>> rates{{-1, 0.5, 0.2}, {2, -0.3}, {0.7}};
      const std::vector<std::vector<Reaction::Powers>> powers{{{1, 2}, {3, 1, 1}, {}}, {{1, 2}, {0, 1}}, {{0, 0, 2}}};
      Reaction reaction(3, memory());
      for (std::size_t i = 0; i < 3; ++i) {
        reaction.set_diffusion(i, diffusion[i]);
        for (std::size_t t = 0; t < rates[i].size(); ++t) reaction.add_term(i, rates[i][t], powers[i][t]);
      }
      const std::vector<Field> before = c;
      step(reaction, {&c[0], &c[1], &c[2]}, 0.3, periodic);
      for (std::size_t i = 0; i < 3; ++i)
        for (int x = 0; x < c[i].nx(); ++x)
          for (int y = 0; y < c[i].ny(); ++y)
            for (int z = 0; z < c[i].nz(); ++z)
              EXPECT_NEAR(c[i].get(x, y, z),
                          changed(before, i, diffusion[i], rates[i], powers[i], 0.3, periodic, x, y, z), kRounding);
    }
  }
}

TEST(Reaction, ComesBackFromAnImage) {
  Reaction reaction(2, memory());
  reaction.set_diffusion(1, 0.3);
  reaction.add_term(0, -1, {1, 2});
  reaction.add_term(1, 0.5, {});
  ByteWriter out;
  reaction.save(out);
  const auto image = out.take();
  ByteReader in(image.data(), image.size());
  Reaction again = Reaction::load(in);
  Field u = random_field(8, 8, 1, 1), v = random_field(8, 8, 1, 2), p = u, q = v;
  step(reaction, {&u, &v}, 1, true);
  step(again, {&p, &q}, 1, true);
  EXPECT_TRUE((u.values() == p.values()).all() && (v.values() == q.values()).all());
  for (std::size_t size = 0; size < image.size(); ++size) {
    ByteReader cut(image.data(), size);
    EXPECT_THROW(Reaction::load(cut), Error);
  }
}

TEST(Reaction, RefusesWhatDoesNotFit) {
  EXPECT_THROW(Reaction(0, memory()), Error);
  EXPECT_THROW(Reaction(9, memory()), Error);
  Reaction reaction(2, memory());
  EXPECT_THROW(reaction.set_diffusion(0, -1), Error);
  EXPECT_THROW(reaction.set_diffusion(0, std::nan("")), Error);
  EXPECT_THROW(reaction.add_term(0, std::nan(""), {}), Error);
  Field u = Field::plane(3, 3), v = Field::plane(3, 4);
  EXPECT_THROW(step(reaction, {&u, &v}, 1, true), Error);
  EXPECT_THROW(step(reaction, {&u}, 1, true), Error);
  EXPECT_THROW(step(reaction, {&u, &u}, 1, true), Error);
}

}  // namespace
}  // namespace breve
