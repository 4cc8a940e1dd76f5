// A camera that goes round what it looks at.
#pragma once

#include "diaphane/values.h"

namespace diaphane::cli {

/// Starts where `first` stands; the target stays in the middle, and up stays up.
class Orbit {
 public:
  /// An `up` of some length, that the view is not along.
  explicit Orbit(const Camera& first);

  /// About the upright axis to the right, and towards its top, at most to 85° above or below the target.
  void turn(double right_deg, double higher_deg);
  /// `factor` times as far away; within a quarter and four times the first distance.
  void move_away(double factor);
  void reset();

  Camera camera() const;

 private:
  Camera first_;
  double azimuth_deg_ = 0;    ///< from where it began
  double elevation_deg_ = 0;  ///< above the target
  double distance_ = 1;       ///< of the first
};

}  // namespace diaphane::cli
