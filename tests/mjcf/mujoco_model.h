/// MJCF text compiled by MuJoCo's compiler: the oracle of these tests
#pragma once

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "math/vec.h"
#include "mechanics/mass_properties.h"
#include "taut/model_def.h"

namespace taut::test {

class MujocoModel {
 public:
  explicit MujocoModel(const std::string& xml) {
    auto vfs = std::make_unique<mjVFS>();
    mj_defaultVFS(vfs.get());
    mj_makeEmptyFileVFS(vfs.get(), "model.xml", static_cast<int>(xml.size()));
    std::memcpy(vfs->filedata[0], xml.data(), xml.size());
    char error[1000] = "";
    model_ = mj_loadXML("model.xml", vfs.get(), error, sizeof error);
    mj_deleteVFS(vfs.get());
    if (model_ == nullptr) {
      ADD_FAILURE() << "MuJoCo: " << error << "\n" << xml;
      return;
    }
    data_ = mj_makeData(model_);
    mj_forward(model_, data_);
  }
  MujocoModel(const MujocoModel&) = delete;
  MujocoModel& operator=(const MujocoModel&) = delete;
  ~MujocoModel() {
    if (data_ != nullptr) mj_deleteData(data_);
    if (model_ != nullptr) mj_deleteModel(model_);
  }

  explicit operator bool() const { return model_ != nullptr; }
  mjModel& model() { return *model_; }
  mjData& data() { return *data_; }
  int Id(mjtObj kind, const std::string& name) const {
    return mj_name2id(model_, kind, name.c_str());
  }
  void Key(int key) {
    mj_resetDataKeyframe(model_, data_, key);
    mj_forward(model_, data_);
  }
  void Step(double step_s, int count) {
    model_->opt.timestep = step_s;
    for (int i = 0; i < count; ++i) mj_step(model_, data_);
    mj_forward(model_, data_);
  }

  static Vec3 Of(const mjtNum* n) { return {n[0], n[1], n[2]}; }
  static Quat QuatOf(const mjtNum* n) { return {n[0], n[1], n[2], n[3]}; }
  Vec3 Com(int body) const { return Of(data_->xipos + 3 * body); }
  /// Returns the inertia in axes of W.
  Inertia InertiaOf(int body) const {
    const mjtNum *r = data_->ximat + 9 * body, *j = model_->body_inertia + 3 * body;
    const auto entry = [&](int x, int y) {
      double sum = 0;
      for (int a = 0; a < 3; ++a) sum += r[3 * x + a] * j[a] * r[3 * y + a];
      return sum;
    };
    return {entry(0, 0), entry(1, 1), entry(2, 2), entry(0, 1), entry(0, 2), entry(1, 2)};
  }
  Vec3 GeomPlace(int geom) const { return Of(data_->geom_xpos + 3 * geom); }
  Vec3 GeomAxis(int geom, int axis) const {
    const mjtNum* r = data_->geom_xmat + 9 * geom;
    return {r[axis], r[3 + axis], r[6 + axis]};
  }
  Vec3 SitePlace(int site) const { return Of(data_->site_xpos + 3 * site); }
  /// Returns the total force of springs, dampers and actuators, positive if it pulls.
  double Tension(int tendon) const {
    const mjtNum l = data_->ten_length[tendon];
    double tension = model_->tendon_stiffness[tendon] * (l - model_->tendon_lengthspring[tendon]);
    for (int a = 0; a < model_->nu; ++a) {
      if (model_->actuator_trntype[a] == mjTRN_TENDON && model_->actuator_trnid[2 * a] == tendon) {
        tension -= model_->actuator_gear[6 * a] * data_->actuator_force[a];
      }
    }
    return tension;
  }

 private:
  mjModel* model_ = nullptr;
  mjData* data_ = nullptr;
};

inline void ExpectNear(const Vec3& a, const Vec3& b, double tolerance) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}
inline void ExpectNear(const Inertia& a, const Inertia& b, double share) {
  const double t = share * (a.xx + a.yy + a.zz);
  EXPECT_NEAR(a.xx, b.xx, t);
  EXPECT_NEAR(a.yy, b.yy, t);
  EXPECT_NEAR(a.zz, b.zz, t);
  EXPECT_NEAR(a.xy, b.xy, t);
  EXPECT_NEAR(a.xz, b.xz, t);
  EXPECT_NEAR(a.yz, b.yz, t);
}

}  // namespace taut::test
