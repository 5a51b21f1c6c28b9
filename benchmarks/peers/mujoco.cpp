/// MuJoCo adapter: free bodies, spatial tendons, and one pull-only actuator per cable.
///
/// The actuator's force is k u - k l - b dl/dt, limited to (-inf, 0], with the control u as rest
/// length. This is paper eq. (1) with one exception: the sum is limited, so a slack cable that
/// lengthens quickly, b dl/dt > k (L - l), already pulls.
#include <mujoco/mujoco.h>

#include <algorithm>
#include <cstring>
#include <stdexcept>

#include "benchmarks/peers/adapters.h"
#include "math/vec.h"

namespace taut::peers {
namespace {

struct Files {
  mjVFS* vfs = new mjVFS;
  Files() { mj_defaultVFS(vfs); }
  Files(const Files&) = delete;
  Files& operator=(const Files&) = delete;
  ~Files() {
    mj_deleteVFS(vfs);
    delete vfs;
  }
};

mjModel* Compile(const std::string& xml) {
  const Files files;
  if (mj_makeEmptyFileVFS(files.vfs, "model.xml", static_cast<int>(xml.size())) != 0) {
    throw std::runtime_error("MuJoCo's virtual file system cannot hold the model");
  }
  std::memcpy(files.vfs->filedata[0], xml.data(), xml.size());
  char error[1000] = "";
  mjModel* const model = mj_loadXML("model.xml", files.vfs, error, sizeof error);
  if (model == nullptr) throw std::invalid_argument(std::string("MuJoCo: ") + error);
  return model;
}

class Mujoco final : public World {
 public:
  Mujoco(const ModelDef& def, const Options& options)
      : model_(Compile(Mjcf(def, options))), data_(mj_makeData(model_)) {
    for (const HeightFieldDef& field : def.height_fields) {
      const std::vector<float> heights = MujocoHeights(field);
      std::copy(heights.begin(), heights.end(), model_->hfield_data);
    }
    mju_user_warning = [](const char*) {};  // Step checks the warnings; prevents a log file
    mj_resetDataKeyframe(model_, data_, 0);
  }
  Mujoco(const Mujoco&) = delete;
  Mujoco& operator=(const Mujoco&) = delete;
  ~Mujoco() override {
    mj_deleteData(data_);
    mj_deleteModel(model_);
  }

  void Step(double step_s, int count) override {
    model_->opt.timestep = step_s;
    for (int i = 0; i < count; ++i) mj_step(model_, data_);
    measured_ = false;
    for (int kind = 0; kind < mjNWARNING; ++kind) {  // contacts without space, diverged state
      const mjWarningStat& warning = data_->warning[kind];
      if (warning.number > 0) throw std::runtime_error(mju_warningText(kind, warning.lastinfo));
    }
  }
  void SetRestLength(int cable, double rest_length_m) override {
    data_->ctrl[cable] = rest_length_m;
    measured_ = false;
  }

  CableState Cable(int cable) const override {
    Measure();
    CableState state;
    state.length_m = data_->ten_length[cable];
    state.rate_m_per_s = data_->ten_velocity[cable];
    state.rest_length_m = data_->ctrl[cable];
    state.tension_n = -data_->actuator_force[cable];
    state.stiffness_n_per_m = model_->actuator_gainprm[cable * mjNGAIN];
    state.elastic_n =
        std::max(0.0, state.stiffness_n_per_m * (state.length_m - state.rest_length_m));
    return state;
  }
  BodyState Body(int body) const override {
    const double *q = data_->qpos + 7 * body, *v = data_->qvel + 6 * body;
    const Quat turn{q[3], q[4], q[5], q[6]};
    return {{q[0], q[1], q[2]}, turn, {v[0], v[1], v[2]}, Rotate(turn, {v[3], v[4], v[5]})};
  }
  MassState Mass(int body) const override {
    Measure();
    const int i = body + 1;  // 0 is the world
    const double *p = data_->xipos + 3 * i, *j = model_->body_inertia + 3 * i;
    Rotation r;
    std::copy(data_->ximat + 9 * i, data_->ximat + 9 * i + 9, r.m);
    return {model_->body_mass[i], {p[0], p[1], p[2]}, Turned(r, {j[0], j[1], j[2]})};
  }
  int ContactCount() const override { return data_->ncon; }

 private:
  /// Updates quantities that depend on positions and velocities, which otherwise belong to the
  /// start of the step.
  void Measure() const {
    if (measured_) return;
    mj_fwdPosition(model_, data_);
    mj_fwdVelocity(model_, data_);
    mj_fwdActuation(model_, data_);
    measured_ = true;
  }
  mjModel* model_;
  mjData* data_;
  mutable bool measured_ = false;
};

}  // namespace

std::unique_ptr<World> MakeMujoco(const ModelDef& def, const Options& options) {
  return std::make_unique<Mujoco>(def, options);
}

std::string MujocoVersion() { return mj_versionString(); }

}  // namespace taut::peers
