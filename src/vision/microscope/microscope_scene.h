#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

namespace microinjection {

/// Corners (x, z) (m) of a closed polygon in the world, in either sense, not necessarily convex;
/// empty for an outline that the cell does not have.
using CellOutline = std::vector<Eigen::Vector2d>;

/// Corners of a circle, or of an ellipse with semi-axes `a` along the direction `angle` (rad, from x
/// towards z) and `b` across it (m). 512 corners leave the true curve by 2e-5 of the radius.
CellOutline circleOutline(const Eigen::Vector2d& centre, double radius, int corners = 512);
CellOutline ellipseOutline(const Eigen::Vector2d& centre, double a, double b, double angle, int corners = 512);

/// How a body looks in focus. In bright field the rim and the line show the border. The border is in
/// the middle of a rim that is as wide inside as outside (zona), or where the dark rim outside meets
/// the bright line inside (ooplasm).
struct BodyOptics {
  double phase = 0;        ///< rad, of the light through the body; negative for a lower refractive index
  double absorption = 0;   ///< share of the light, in [-1, 1]; negative where the body focuses light
  double rim = 0;          ///< share of the light that the refraction at the border takes from a band along it
  double rim_inside = 0;   ///< m, width of this band inside the border
  double rim_outside = 0;  ///< m, outside
  double line = 0;         ///< share of the light that a line along the border gains, just inside
  double line_width = 0;   ///< m
  double dome = 0;         ///< absorption that increases towards the middle, as the thickness does
  double granules = 0;     ///< rms contrast of the texture
};

/// A round body in a cell: polar body or nucleus.
struct CellBody {
  Eigen::Vector2d centre{0, 0};  ///< (x, z), m
  double radius = 0;             ///< m
  BodyOptics optics;

  static CellBody polarBody(const Eigen::Vector2d& centre, double radius);
  static CellBody nucleus(const Eigen::Vector2d& centre, double radius);
};

/// A cell as its equatorial plane shows it.
struct CellScene {
  CellOutline zona_outer, zona_inner, ooplasm;
  double y = 0;                    ///< m, of the equatorial plane
  Eigen::Vector2d material{0, 0};  ///< (x, z), m, where the texture of the cell has its origin: it moves with the cell
  std::uint64_t texture_seed = 1;  ///< of the place in the texture
  BodyOptics zona{0.35, 0, 0.14, 0.5e-6, 0.5e-6, 0, 0, 0, 0.035};
  BodyOptics perivitelline{-0.15, 0, 0.10, 0.4e-6, 0.4e-6, 0, 0, 0, 0};
  BodyOptics cytoplasm{0.5, 0.10, 0.42, 0, 1.6e-6, 0.22, 0.8e-6, 0.10, 0.085};
  std::optional<CellBody> polar_body, nucleus;

  /// A cell of two or three concentric circles (m); a zona thickness of 0 leaves the zona out.
  static CellScene round(const Eigen::Vector2d& centre, double radius, double zona_thickness, double perivitelline_gap);
};

/// How a glass tube looks from the side, in focus.
struct PipetteOptics {
  double wall = 0.8;          ///< share of the light that thick walls take; negative for walls that focus light
  double core = 0.7;          ///< share that a line along the axis gains; it may exceed 1
  double core_share = 0.4;    ///< width of this line over the inner diameter
  double lumen = 0.35;        ///< share of the light that is missing beside the core
  double phase = 0.5;         ///< rad, of the edges: strength of the fringes
  double full_wall = 0.5e-6;  ///< m, of wall thickness at which the wall takes (1 - 1/e) of its share
};

/// The pipette that holds the cell. Its lip is round, as heat leaves it; the mouth is where the lip
/// ends.
struct HoldingPipette {
  Eigen::Vector2d mouth{0, 0};  ///< (x, z), m, the middle of the mouth
  Eigen::Vector2d axis{0, -1};  ///< (x, z), of unit length, from the mouth towards the shaft
  double y = 0;                 ///< m, of the axis
  double outer_radius = 40e-6;  ///< m, at the mouth
  double inner_radius = 25e-6;  ///< m
  double taper = 0;             ///< growth of the radius over the length
  PipetteOptics optics{0.65, 0.2, 0.8, 0.1, 0.5, 1.5e-6};
};

/// What a needle has drawn into its bore: a column of the cell's inside, from the mouth to a cap.
struct BoreColumn {
  double length = 0;  ///< m along the axis, from the mouth to the middle of the cap; above 0
  double bulge = 0;   ///< m, of the cap's middle ahead of its edge
  std::uint64_t texture_seed = 1;
  BodyOptics optics{0.5, 0.10, 0.42, 0, 1.6e-6, 0.22, 0.8e-6, 0, 0.085};

  /// Behind a whole membrane, which the bore's edge rounds: a cap of at most half a sphere.
  static BoreColumn tongue(double length, double bore_radius);
  /// After the membrane has broken: cytoplasm up to its border with the pipette's own liquid, nearly flat.
  static BoreColumn cytoplasm(double length, double bore_radius);
};

/// The needle. Its end is cut straight; the tube widens behind it.
struct InjectionPipette {
  Eigen::Vector3d tip{0, 0, 0};   ///< m, (x, y, z): the end of the axis
  Eigen::Vector3d axis{0, 0, 1};  ///< of unit length, from the tip towards the shaft; not along y
  double tip_radius = 1.0e-6;     ///< m, outer
  double wall = 0.25;             ///< of the outer radius
  double taper = 0.06;            ///< growth of the radius over the length
  double shaft_radius = 40e-6;    ///< m, where the taper ends
  PipetteOptics optics;
  std::optional<BoreColumn> column{};  ///< none: the bore is empty
};

/// Something beside the cell, a disc in its own plane.
struct Debris {
  enum class Kind { kDust, kBubble };
  Kind kind = Kind::kDust;
  Eigen::Vector3d centre{0, 0, 0};  ///< m, (x, y, z)
  double radius = 1e-6;             ///< m
};

/// What lies under the microscope, in the world (m). Everything may be absent.
struct MicroscopeScene {
  std::vector<CellScene> cells;
  std::optional<HoldingPipette> holding;
  std::optional<InjectionPipette> injection;
  std::vector<Debris> debris;

  /// Throws ConfigError with everything that cannot be rendered: numbers that are not finite,
  /// outlines of one or two corners, axes that have not unit length, radii that are not positive.
  void validate() const;
};

}  // namespace microinjection
