// SPDX-License-Identifier: GPL-3.0-or-later
// A robot in Pinocchio, made from a file with a line for each link (bench/robots_beside.py, write_links):
// NAME TYPE PARENT  place x 3  axes x 9 (rows)  axis x 3  mass  centre x 3  moments and products about the origin x 6.
// Header-only, so that an include path is enough and everything is compiled for this processor.
#pragma once

#include <fstream>
#include <pinocchio/multibody/data.hpp>
#include <pinocchio/multibody/model.hpp>
#include <stdexcept>
#include <string>
#include <vector>

namespace engines {

struct PinocchioLink {
  std::string name, type;
  int parent = -1;
  pinocchio::SE3 placement;
  Eigen::Vector3d axis;
  pinocchio::Inertia inertia;
};

inline std::vector<PinocchioLink> links_of(const std::string& path) {
  std::ifstream file(path);
  std::vector<PinocchioLink> links;
  for (PinocchioLink link; file >> link.name >> link.type >> link.parent;) {
    Eigen::Matrix<double, 25, 1> v;
    for (double& value : v) file >> value;
    if (!file) throw std::runtime_error("the file has an incomplete line");
    const Eigen::Vector3d centre = v.segment<3>(16);
    Eigen::Matrix3d about_origin;
    about_origin << v[19], v[22], v[23], v[22], v[20], v[24], v[23], v[24], v[21];
    const Eigen::Matrix3d steiner =
        v[15] * (centre.squaredNorm() * Eigen::Matrix3d::Identity() - centre * centre.transpose());
    const Eigen::Matrix3d axes = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(v.data() + 3);
    link.placement = pinocchio::SE3(axes, v.head<3>());
    link.axis = v.segment<3>(12);
    link.inertia = pinocchio::Inertia(v[15], centre, about_origin - steiner);
    links.push_back(link);
  }
  return links;
}

// Joints along axes of their frame have types of their own, as in Pinocchio's reader of URDF.
template <class X, class Y, class Z, class Any>
pinocchio::JointModel joint_along(const Eigen::Vector3d& axis) {
  if (axis == Eigen::Vector3d::UnitX()) return X();
  if (axis == Eigen::Vector3d::UnitY()) return Y();
  if (axis == Eigen::Vector3d::UnitZ()) return Z();
  return Any(axis);
}

inline pinocchio::JointModel joint_of(const PinocchioLink& link) {
  using namespace pinocchio;
  return link.type == "pin"
             ? joint_along<JointModelRX, JointModelRY, JointModelRZ, JointModelRevoluteUnaligned>(link.axis)
             : joint_along<JointModelPX, JointModelPY, JointModelPZ, JointModelPrismaticUnaligned>(link.axis);
}

// With a free flyer, it stands for the first six links, which are the translations and rotations of the base.
inline pinocchio::Model model_of(const std::vector<PinocchioLink>& links, bool has_free_flyer = false) {
  pinocchio::Model model;
  model.gravity.linear(Eigen::Vector3d(0, 0, -9.81));
  std::vector<pinocchio::JointIndex> joints;
  if (has_free_flyer) {
    const pinocchio::JointIndex base =
        model.addJoint(0, pinocchio::JointModelFreeFlyer(), pinocchio::SE3::Identity(), "base");
    model.appendBodyToJoint(base, links.at(5).inertia, pinocchio::SE3::Identity());
    joints.assign(6, base);
  }
  for (std::size_t i = joints.size(); i < links.size(); ++i) {
    const PinocchioLink& link = links[i];
    const pinocchio::JointIndex parent = link.parent < 0 ? 0 : joints.at(static_cast<std::size_t>(link.parent));
    joints.push_back(model.addJoint(parent, joint_of(link), link.placement, link.name));
    model.appendBodyToJoint(joints.back(), link.inertia, pinocchio::SE3::Identity());
  }
  return model;
}

}  // namespace engines
