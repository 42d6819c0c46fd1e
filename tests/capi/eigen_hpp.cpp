// breve/eigen.hpp: maps of vectors and poses, and bulk calls into matrices.
#include "breve/eigen.hpp"

#include <gtest/gtest.h>

namespace {

TEST(EigenHpp, MapsShareTheMemoryOfVectorsAndPoses) {
  breve::Vector v{1, 2, 3};
  breve::map(v) *= 2;
  EXPECT_EQ(v, (breve::Vector{2, 4, 6}));
  EXPECT_EQ(breve::vector_of(Eigen::Vector3d(1, 0, 5)), (breve::Vector{1, 0, 5}));
  breve_pose pose{{1, 2, 3}, {1, 0, 0, 0}};
  breve::location(pose) += Eigen::Vector3d::UnitX();
  EXPECT_EQ(pose.location[0], 2);
}

TEST(EigenHpp, PosesAndTransformsAgree) {
  const Eigen::Quaterniond rotation(Eigen::AngleAxisd(0.5, Eigen::Vector3d(1, 2, 2).normalized()));
  const breve_pose pose = breve::pose_of(Eigen::Vector3d(1, 2, 3), rotation);
  const Eigen::Isometry3d transform = breve::transform(pose);
  EXPECT_LT(
      (transform * Eigen::Vector3d(1, 0, 0) - (rotation * Eigen::Vector3d(1, 0, 0) + Eigen::Vector3d(1, 2, 3))).norm(),
      1e-15);
  const breve_pose again = breve::pose_of(transform);
  EXPECT_LT((breve::rotation(again).coeffs() - rotation.coeffs()).norm(), 1e-15);
  EXPECT_EQ(breve::location(again), breve::location(pose));
}

template <class Number>
void read_places() {
  auto runtime = breve::Runtime::create().or_throw();
  auto program =
      runtime.compile("a.tz", "@use Control.\n@use Mobile.\nController A.\nControl : A { + to init: 3 new Mobiles. }")
          .or_throw();
  auto world = runtime.world(program).or_throw();
  const auto all = world.objects("Mobile").or_throw();
  for (std::size_t i = 0; i < all.size(); ++i)
    world.set_pose(all[i], breve::pose_of(Eigen::Vector3d(double(i), 2, 0), Eigen::Quaterniond::Identity())).or_throw();
  Eigen::Matrix<Number, Eigen::Dynamic, 3, Eigen::RowMajor> places(3, 3);
  world.get_all(all.data(), all.size(), BREVE_PROPERTY_LOCATION, breve::rows(places)).or_throw();
  EXPECT_EQ(places.col(0).sum(), Number(3));
  EXPECT_EQ(places.col(1).minCoeff(), Number(2));
}

TEST(EigenHpp, BulkCallsFillTheRowsOfAMatrix) {
  read_places<double>();
  read_places<float>();
}

}  // namespace
