// Pinocchio's forward kinematics of many configurations, without Python in between.
//
// pinocchio_loop.py builds it on the spot and calls it through ctypes. The model comes
// as numbers, since the headers of URDF's parser are not part of the wheel.

// As its own build does: there are more kinds of joints than Boost expects.
#define BOOST_MPL_CFG_NO_PREPROCESSED_HEADERS
#define BOOST_MPL_LIMIT_LIST_SIZE 30
#define BOOST_MPL_LIMIT_VECTOR_SIZE 30

#include <pinocchio/algorithm/kinematics.hpp>
#include <pinocchio/multibody.hpp>

#include <string>
#include <utility>
#include <vector>

using namespace pinocchio;

struct Loop
{
  Model model;
  Data data;
  std::vector<std::pair<JointIndex, Eigen::Vector3d>> points;
};

static SE3 placement(const double * matrix)
{
  using Rows = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>;
  return SE3(Eigen::Map<const Rows>(matrix).eval());
}

extern "C" {

// A tree of joints about their own y axes. Parents and placements (joints, 4, 4) are in
// Pinocchio's order; points are fixed to joints, at offsets (points, 3).
Loop * loop_new(
  const int * parents, const double * placements, int joints,
  const int * holders, const double * offsets, int points)
{
  Loop * loop = new Loop;
  for (int i = 0; i < joints; ++i)
    loop->model.addJoint(
      parents[i], JointModelRY(), placement(placements + 16 * i), std::to_string(i));
  loop->data = Data(loop->model);
  for (int i = 0; i < points; ++i)
    loop->points.emplace_back(holders[i], Eigen::Map<const Eigen::Vector3d>(offsets + 3 * i));
  return loop;
}

void loop_delete(Loop * loop) { delete loop; }

// Placements of all joints in n configurations, and nothing read.
void loop_joints(Loop * loop, const double * q, long n)
{
  const long nq = loop->model.nq;
  for (long i = 0; i < n; ++i)
    forwardKinematics(
      loop->model, loop->data, Eigen::Map<const Eigen::VectorXd>(q + i * nq, nq));
}

// The same, and the points of each configuration, (n, points, 3).
void loop_points(Loop * loop, const double * q, long n, double * out)
{
  const long nq = loop->model.nq;
  for (long i = 0; i < n; ++i)
  {
    forwardKinematics(
      loop->model, loop->data, Eigen::Map<const Eigen::VectorXd>(q + i * nq, nq));
    for (const auto & [joint, offset] : loop->points)
    {
      Eigen::Map<Eigen::Vector3d> point(out);
      point = loop->data.oMi[joint].act(offset);
      out += 3;
    }
  }
}
}
