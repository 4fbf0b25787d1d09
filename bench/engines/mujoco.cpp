// SPDX-License-Identifier: GPL-3.0-or-later
// MuJoCo: qacc_smooth, without contacts, limits, friction of joints and sensors.
#include <mujoco/mujoco.h>

#include "measure.hpp"

namespace {

class MuJoCo {
 public:
  explicit MuJoCo(const engines::Arguments& arguments) {
    char error[500] = "";
    model_ = mj_loadXML(arguments.file.c_str(), nullptr, error, sizeof error);
    if (model_ == nullptr) throw std::runtime_error(error);
    data_ = mj_makeData(model_);
    if (model_->nq != model_->nv || model_->neq > 0 || static_cast<std::size_t>(model_->nv) != arguments.n)
      throw std::runtime_error("free joints or equalities");
    for (const std::string& name : arguments.joints) {
      const int joint = mj_name2id(model_, mjOBJ_JOINT, name.c_str());
      if (joint < 0) throw std::runtime_error("no joint " + name);
      place_.push_back(model_->jnt_qposadr[joint]);
    }
  }
  void forward(const double* x, double* a) {
    const std::size_t n = place_.size();
    for (std::size_t i = 0; i < n; ++i) {
      data_->qpos[place_[i]] = model_->qpos0[place_[i]] + x[i];
      data_->qvel[place_[i]] = x[n + i];
    }
    mj_kinematics(model_, data_);
    mj_comPos(model_, data_);
    mj_crb(model_, data_);
    mj_factorM(model_, data_);
    mj_comVel(model_, data_);
    mj_passive(model_, data_);
    mj_rne(model_, data_, 0, data_->qfrc_bias);
    for (int i = 0; i < model_->nv; ++i) data_->qfrc_smooth[i] = data_->qfrc_passive[i] - data_->qfrc_bias[i];
    mj_solveM(model_, data_, data_->qacc_smooth, data_->qfrc_smooth, 1);
    for (std::size_t i = 0; i < n; ++i) a[i] = data_->qacc_smooth[place_[i]];
  }

 private:
  mjModel* model_;
  mjData* data_;
  std::vector<int> place_;
};

}  // namespace

int main(int argc, char** argv) { return engines::compare<MuJoCo>(argc, argv); }
