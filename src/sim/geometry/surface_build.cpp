// Lookup tables of height fields and meshes: maximum pyramid, uniform grid of buckets.
#include "sim/geometry/surface_build.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace taut::sim {
namespace {

/// Number of grid buckets per triangle: a compromise between buckets per triangle and triangles per
/// bucket.
constexpr double kBucketsPerTriangle = 2.0;
constexpr double kMostBuckets = 4e6;
/// Maximum number of entries in all buckets. Each triangle is in all buckets of its bounding box,
/// so long diagonal triangles could be in millions.
constexpr double kEntriesPerTriangle = 16.0, kMostFurtherEntries = 1e6;

bool Rises(const HeightFieldDef& field, int i, int j) {
  const auto at = [&](int column, int row) {
    return field.height_m[static_cast<std::size_t>(row) * static_cast<std::size_t>(field.columns) +
                          static_cast<std::size_t>(column)];
  };
  switch (field.split) {
    case HeightFieldDef::Split::kSame:
      return true;
    case HeightFieldDef::Split::kAlternating:
      return (i + j) % 2 == 0;
    case HeightFieldDef::Split::kShortest:
      return std::fabs(at(i + 1, j + 1) - at(i, j)) <= std::fabs(at(i, j + 1) - at(i + 1, j));
  }
  return true;
}

}  // namespace

Surface::Surface(const HeightFieldDef& field) : height_m_(field.height_m) {
  SurfaceTable& t = *table_;
  t.is_field = t.solid = true;
  t.columns = field.columns;
  t.rows = field.rows;
  t.cell_m = field.cell_m;
  t.inv_cell = 1.0 / field.cell_m;
  for (double& z : height_m_) z += field.origin_m.z;
  const auto [least, most] = std::minmax_element(height_m_.begin(), height_m_.end());
  const int columns = field.columns - 1, rows = field.rows - 1;
  t.low = {field.origin_m.x - 0.5 * columns * field.cell_m,
           field.origin_m.y - 0.5 * rows * field.cell_m, *least};
  t.high = {t.low.x + columns * field.cell_m, t.low.y + rows * field.cell_m, *most};
  t.height_m = height_m_.data();
  std::vector<double> top;
  marks_.assign(height_m_.size(), 0);
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      const int at = j * field.columns + i;
      if (Rises(field, i, j)) marks_[static_cast<std::size_t>(at)] = kRising;
      const double* const z = t.height_m + at;
      top.push_back(std::max({z[0], z[1], z[field.columns], z[field.columns + 1]}));
    }
  }
  t.marks = marks_.data();
  MarkField();
  tops_.push_back(std::move(top));
  for (int width = columns, height = rows; width > 1 || height > 1;) {
    const int w = (width + 1) / 2, h = (height + 1) / 2;
    std::vector<double> upper(static_cast<std::size_t>(w) * static_cast<std::size_t>(h), -1e300);
    for (int j = 0; j < height; ++j) {
      for (int i = 0; i < width; ++i) {
        double& to = upper[static_cast<std::size_t>(j / 2 * w + i / 2)];
        to = std::max(to, tops_.back()[static_cast<std::size_t>(j * width + i)]);
      }
    }
    tops_.push_back(std::move(upper));
    width = w, height = h;
  }
  t.levels = static_cast<int>(tops_.size());
  for (std::size_t level = 0; level < tops_.size(); ++level) t.tops[level] = tops_[level].data();
}

Surface::Surface(const TerrainMeshDef& mesh) : corners_(mesh.corners_m) {
  SurfaceTable& t = *table_;
  t.solid = mesh.solid;
  for (const std::array<int, 3>& triangle : mesh.triangles) {
    triangles_.insert(triangles_.end(), triangle.begin(), triangle.end());
  }
  t.corners = corners_.data();
  t.triangles = triangles_.data();
  t.low = t.high = corners_.front();
  for (const Vec3& p : corners_) {
    t.low = {std::min(t.low.x, p.x), std::min(t.low.y, p.y), std::min(t.low.z, p.z)};
    t.high = {std::max(t.high.x, p.x), std::max(t.high.y, p.y), std::max(t.high.z, p.z)};
  }
  const Vec3 size = t.high - t.low;
  const double longest = std::max({size.x, size.y, size.z});
  // About as many buckets as triangles for bent surfaces; fewer for thin ones.
  const double count = static_cast<double>(mesh.triangles.size());
  t.bucket_m = longest / std::clamp(std::sqrt(kBucketsPerTriangle * count), 1.0, 1024.0);
  const auto buckets = [&](double extent) {
    return std::max(1, static_cast<int>(std::ceil(extent / t.bucket_m)));
  };
  const auto set_buckets = [&] {
    t.inv_bucket = 1.0 / t.bucket_m;
    t.buckets[0] = buckets(size.x), t.buckets[1] = buckets(size.y), t.buckets[2] = buckets(size.z);
  };
  const auto span = [&](std::size_t k, int* low, int* high) {
    for (int axis = 0; axis < 3; ++axis) {
      const auto at = [&](int corner) {
        const Vec3 p = corners_[static_cast<std::size_t>(corner)] - t.low;
        return (axis == 0 ? p.x : axis == 1 ? p.y : p.z) * t.inv_bucket;
      };
      const auto& v = mesh.triangles[k];
      low[axis] = CellAt(std::min({at(v[0]), at(v[1]), at(v[2])}), t.buckets[axis]);
      high[axis] = CellAt(std::max({at(v[0]), at(v[1]), at(v[2])}), t.buckets[axis]);
    }
  };
  // The sum is a double, because it may exceed an int by far.
  const auto entries = [&] {
    double sum = 0;
    for (std::size_t k = 0; k < mesh.triangles.size(); ++k) {
      int low[3], high[3];
      span(k, low, high);
      sum += static_cast<double>(high[0] - low[0] + 1) * (high[1] - low[1] + 1) *
             (high[2] - low[2] + 1);
    }
    return sum;
  };
  while (static_cast<double>(buckets(size.x)) * buckets(size.y) * buckets(size.z) > kMostBuckets) {
    t.bucket_m *= 1.25;
  }
  set_buckets();
  const double most_entries = kEntriesPerTriangle * count + kMostFurtherEntries;
  while (t.buckets[0] * t.buckets[1] * t.buckets[2] > 1 && entries() > most_entries) {
    t.bucket_m *= 1.25;
    set_buckets();
  }
  const auto all = static_cast<std::size_t>(t.buckets[0]) * static_cast<std::size_t>(t.buckets[1]) *
                   static_cast<std::size_t>(t.buckets[2]);
  const auto each = [&](const auto& use) {
    for (std::size_t k = 0; k < mesh.triangles.size(); ++k) {
      int low[3], high[3];
      span(k, low, high);
      for (int z = low[2]; z <= high[2]; ++z) {
        for (int y = low[1]; y <= high[1]; ++y) {
          for (int x = low[0]; x <= high[0]; ++x) {
            use(static_cast<std::size_t>((z * t.buckets[1] + y) * t.buckets[0] + x),
                static_cast<int>(k));
          }
        }
      }
    }
  };
  first_in_bucket_.assign(all + 1, 0);
  each([&](std::size_t bucket, int) { ++first_in_bucket_[bucket + 1]; });
  for (std::size_t b = 0; b < all; ++b) first_in_bucket_[b + 1] += first_in_bucket_[b];
  in_bucket_.resize(static_cast<std::size_t>(first_in_bucket_.back()));
  std::vector<int> next(first_in_bucket_.begin(), first_in_bucket_.end() - 1);
  each([&](std::size_t bucket, int triangle) {
    in_bucket_[static_cast<std::size_t>(next[bucket]++)] = triangle;
  });
  t.first_in_bucket = first_in_bucket_.data();
  t.in_bucket = in_bucket_.data();
  FindSharp();
}

void Surface::Join(const SeamList& seams) {
  alone_ = std::make_unique<SurfaceTable>(*table_);
  table_->seams = seams;
  table_->alone = alone_.get();
}

}  // namespace taut::sim
