#pragma once

// A scene of triangles as a source of virtual lights, the receiver that a camera sees in it, and
// the exact light of the two.

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "paths/family.h"
#include "render/share_table.h"
#include "render/triangle_mesh.h"

namespace assay::virtual_lights {

using paths::Vertex;
using render::Rgb;

struct Enclosure {
  /// Why the triangles do not enclose the point; empty where they do.
  std::string why_open;
  /// Why they do not form one convex room; empty where they do.
  std::string why_not_convex;
  /// True if triangles are seen counter-clockwise from inside.
  bool counter_clockwise = true;
  /// The wall that each triangle is part of, in a convex room: triangles of one plane share a
  /// number.
  std::vector<std::uint32_t> wall_of;
};

/// Vertices at the same position, bit by bit, are one. Walls are planes to 1e-9 of the longest side
/// of the mesh along an axis. Closed: every edge runs once each way, and the surface winds about
/// the point once. Convex: connected, and convex at every edge, which makes it convex as a whole
/// (Tietze 1928, Nakajima 1928).
Enclosure enclosure(const render::TriangleMesh& mesh, const render::Vector3& point);

/// The way of light from the point y0 of what emits to the point y1 where it arrives, y1 being the
/// virtual light.
struct LightPath {
  Vertex from;
  Vertex at;  ///< Without a surface: the light has left the scene.
  /// Emitted power divided by the density of the path. The point y0 is drawn in proportion to the
  /// radiance averaged over the colours, the direction in proportion to the cosine.
  Rgb power;

  double from_cosine() const { return dot(at.arriving, from.normal); }
  double at_cosine() const { return -dot(at.arriving, at.normal); }
  double squared_distance() const { return squared_length(at.position - from.position); }
};

class Room {
 public:
  /// Emitters emit on both sides, in a closed room on the inner side alone. `world` must have
  /// light, and its camera must see a surface. The receiver has the lobe of exponent `shininess`.
  explicit Room(paths::SharedMesh world, double shininess = 0);

  const paths::MeshWorld& world() const { return *world_; }
  const Vertex& receiver() const { return receiver_; }
  const Enclosure& walls() const { return enclosure_; }

  LightPath shoot(Stream& random, Cost& cost) const;

  /// The reflection of a receiver of exponent m towards a viewer straight above it, over a diffuse
  /// one's: (m + 2) / 2 c^m for light at the cosine c to its normal. The albedo is the same
  /// (Lafortune and Willems 1994, with the normal as the mirror's direction).
  double lobe(double cosine) const {
    return shininess_ == 0 ? 1 : (shininess_ + 2) / 2 * std::pow(cosine, shininess_);
  }
  double shininess() const { return shininess_; }

  /// cos+ cos+' / r^2 between the receiver and a virtual light, whatever stands between, times the
  /// receiver's lobe.
  double geometry(const Vertex& light) const;
  bool sees(const Vertex& light, Cost& cost) const { return world_->sees(receiver_, light, cost); }
  /// The radiance that the receiver reflects of one virtual light that it sees.
  Rgb reflected(const LightPath& path, double geometry) const;

  /// Density of y1 by area whatever y0: its irradiance over all power, by Lambert's formula. Only
  /// where why_no_marginal() is empty.
  double marginal_density(const Vertex& at) const;
  const std::string& why_no_marginal() const { return why_no_marginal_; }

  /// The radiance that all inner sides emit, if it is the same everywhere in a closed room.
  const std::optional<Rgb>& even_emission() const { return even_emission_; }
  /// The form factor from the receiver to a triangle that nothing hides.
  double form_factor(std::size_t triangle) const { return form_factor(receiver_, triangle); }
  /// The share of all power of each wall of a convex room, by the number of the wall.
  std::vector<double> shares_of_power() const;

 private:
  double form_factor(const Vertex& from, std::size_t triangle) const;
  double brightness(std::size_t triangle) const {
    return render::mean(world_->surface(2 * triangle).emission);
  }

  paths::SharedMesh world_;
  double shininess_;
  Vertex receiver_;
  Enclosure enclosure_;
  std::vector<std::uint32_t> sides_;  // that emit: patches of the world
  std::vector<std::uint32_t> lamps_;  // triangles that emit
  render::ShareTable shares_;
  std::optional<Rgb> even_emission_;
  std::string why_no_marginal_;
};

using SharedRoom = std::shared_ptr<const Room>;

/// The density that the target is divided by.
enum class Weighting {
  conditional,  ///< of y1 given y0, in the space of paths
  marginal,     ///< of y1
};

/// A number, or why it is not known.
struct Known {
  std::optional<double> value = {};
  std::string why_not = {};
};

/// G, the integral of the target over the points that the shooting can reach. The target is the
/// density by area of y1 in the receiver's diffuse reflection, cos cos' V / (pi r^2).
///
/// A convex room has G by form factors F of its walls. The conditional density sums F times the
/// share of power that is not on the wall itself. The marginal density sums F over the walls that
/// some light reaches; it has G = 1 in any closed room that emits evenly.
Known target_integral(const Room& room, Weighting weighting);

/// The radiance that the receiver sends after exactly two reflections in a closed room that emits
/// evenly, in units of Le. It is a Le a' if all walls reflect a', and a Le sum F a' of a convex
/// room.
///
/// It is that of the scene as described. Shooting moves its points (paths::mesh_resolution), which
/// changes virtual lights by some 2^-14 of a wall's length over the receiver's distance to the
/// nearest other wall. That is 1e-4 in the middle of a cube, and up to a hundredth at a 200th of
/// its side from two walls.
std::optional<Rgb> twice_reflected(const Room& room);

}  // namespace assay::virtual_lights
