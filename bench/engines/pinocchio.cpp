// SPDX-License-Identifier: GPL-3.0-or-later
// Pinocchio: aba, the recursion of articulated bodies.
#include <pinocchio/algorithm/aba.hpp>

#include "measure.hpp"
#include "pinocchio_model.hpp"

namespace {

class Pinocchio {
 public:
  explicit Pinocchio(const engines::Arguments& arguments)
      : n_(arguments.n),
        damping_(arguments.damping),
        model_(engines::model_of(engines::links_of(arguments.file))),
        data_(model_) {
    if (static_cast<std::size_t>(model_.nv) != n_) throw std::runtime_error("another number of coordinates");
    for (const std::string& name : arguments.joints) {
      if (!model_.existJointName(name)) throw std::runtime_error("no joint " + name);
      place_.push_back(model_.joints[model_.getJointId(name)].idx_v());
    }
    q_ = v_ = tau_ = Eigen::VectorXd::Zero(model_.nv);
  }
  void forward(const double* x, double* a) {
    for (std::size_t i = 0; i < n_; ++i) {
      q_[place_[i]] = x[i];
      v_[place_[i]] = x[n_ + i];
      tau_[place_[i]] = -damping_[i] * x[n_ + i];
    }
    pinocchio::aba(model_, data_, q_, v_, tau_);
    for (std::size_t i = 0; i < n_; ++i) a[i] = data_.ddq[place_[i]];
  }

 private:
  std::size_t n_;
  std::vector<double> damping_;
  pinocchio::Model model_;
  pinocchio::Data data_;
  Eigen::VectorXd q_, v_, tau_;
  std::vector<Eigen::Index> place_;
};

}  // namespace

int main(int argc, char** argv) { return engines::compare<Pinocchio>(argc, argv); }
