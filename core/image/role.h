#pragma once
#include <array>
#include <bitset>
#include <optional>
#include <string_view>

namespace aftershade {

/// What a channel means to the effects; in canonical units (DESIGN 2).
enum class Role {
  depth,          ///< 1 plane: planar distance along the view axis in metres, positive; +inf is background
  depth2,         ///< 1 plane: the same of what the pixel's ray meets next behind that surface; +inf: nothing
  normal,         ///< 3 planes: unit normal in camera space (+X right, +Y up, +Z forward), facing the camera
  velocity_prev,  ///< 2 planes: where the surface was one frame before, minus where it is, pixels, y down; NaN: unknown
  velocity_next,  ///< 2 planes: where it will be one frame later, minus where it is, pixels, y down; NaN: unknown
  ambient,        ///< 3 planes: the ambient or indirect light contained in the beauty, scene-linear
  ao,             ///< 1 plane: an ambient occlusion the file already has, 1 = open
};
inline constexpr int kRoleCount = 7;

struct RoleInfo {
  Role role;
  std::string_view name;  ///< as the command line and the profiles spell it
  int planes;
};
inline constexpr std::array<RoleInfo, kRoleCount> kRoles{{{Role::depth, "depth", 1},
                                                          {Role::depth2, "depth2", 1},
                                                          {Role::normal, "normal", 3},
                                                          {Role::velocity_prev, "velocity_prev", 2},
                                                          {Role::velocity_next, "velocity_next", 2},
                                                          {Role::ambient, "ambient", 3},
                                                          {Role::ao, "ao", 1}}};
constexpr const RoleInfo& info(Role role) { return kRoles[static_cast<size_t>(role)]; }
/// One of the two depths, which are stored and converted alike.
constexpr bool is_depth(Role role) { return role == Role::depth || role == Role::depth2; }
inline std::optional<Role> role_from_name(std::string_view name) {
  for (const RoleInfo& entry : kRoles)
    if (entry.name == name) return entry.role;
  return std::nullopt;
}

/// A set of roles.
class RoleSet {
 public:
  RoleSet() = default;
  RoleSet(std::initializer_list<Role> roles) {
    for (Role role : roles) insert(role);
  }
  void insert(Role role) { bits_.set(static_cast<size_t>(role)); }
  void insert(RoleSet other) { bits_ |= other.bits_; }
  bool contains(Role role) const { return bits_.test(static_cast<size_t>(role)); }
  bool empty() const { return bits_.none(); }

 private:
  std::bitset<kRoleCount> bits_;
};

}  // namespace aftershade
