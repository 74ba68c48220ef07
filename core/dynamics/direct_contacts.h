// Contacts through which heavy bodies rest on light ones, and those of small groups that carry
// several times a body's weight: their normal impulses, solved at once.
//
// Sweeps pass a load on from contact to contact, and where a light body carries a heavy one, or one
// body many, each takes it on by a small part only. Here the points that push are the rows of one
// system, factored as joints are (LDLᵀ) where they share bodies; what would have to pull is let go,
// and the rest solved again (an active set, as in D. Baraff, "Fast contact force computation for
// nonpenetrating rigid bodies", 1994). These contacts are rigid: a soft one would give way. The
// sweeps leave their normal impulses alone, and do their friction; unless it carries: then it has
// rows of its own, and what would slip is given back to the sweeps.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/dynamics/body_links.h"
#include "core/dynamics/joint_factor.h"
#include "core/dynamics/row_geometry.h"
#include "core/math/product_sum.h"

namespace lockstone {

class DirectContacts {
 public:
  /// A contact as the solver has it.
  struct Link : ContactPair {
    std::uint32_t row_a = 0, row_b = 0;  // where their velocities stand
    std::int32_t share_b = 0;            // of B in the pair's inverse mass, Q30
    bool is_loaded = false;              // carries several times the weight of its lighter body
  };

  /// Room for so many numbers of bodies, of which so many can be pushed. No function but this
  /// allocates.
  [[gnu::cold]] DirectContacts(std::size_t body_capacity, std::size_t pushed_capacity,
                               std::size_t contact_capacity);

  void clear();

  /// In the order of the records. All contacts, if any is worth it.
  void add(const Link& link) { links_.push_back(link); }

  /// A body whose contacts are left to the sweeps.
  void leave_out(std::uint32_t body) { left_out_.push_back(body); }

  /// Whether a contact shares its bodies' inverse masses so unevenly that it may be worth it.
  [[nodiscard]] static bool is_uneven(std::int32_t share_b);

  /// Chooses contacts, takes their normals from the sweeps, and plans the systems.
  void plan(const ContactRun& run);

  [[nodiscard]] bool empty() const { return groups_.empty(); }
  [[nodiscard]] std::size_t contacts() const { return contacts_.size(); }

  /// Normal impulses such that no point closes; with `pushes_out`, such that overlap goes.
  void solve(const ContactRun& run, bool pushes_out);

  /// Blocks get the friction that was solved here. After the last substep.
  void store(const ContactRun& run) const;

 private:
  enum class Mark : std::uint8_t { none, chosen, dropped, listed };
  // Friction that is solved along: two tangents and the twist, at the contact's centre.
  struct Tie {
    std::array<ContactRow, 3> rows{};
    std::uint32_t count = 0;
    std::int64_t radius = 0;  // of the twist, ρ/ℓ, Q30
    std::int64_t coefficient = 0;
    std::array<std::int64_t, 3> words{};  // of the block: masses, which are 0 meanwhile
    bool holds = false;
  };
  struct Contact : ContactRows {
    std::uint32_t row_a = 0, row_b = 0;
    std::array<std::uint8_t, lanes::k_block_points> order{};  // of active points
    std::uint32_t active = 0;
    std::uint32_t active_bits = 0;  // bit i: point i pushes, or closes
    std::uint32_t barred_bits = 0;  // for the rest of a solve
    std::uint32_t tie = 0;          // in ties_, + 1; 0: its friction is left to the sweeps
    // What stands in each of the factors: active bits, and one above them where it is tied.
    std::array<std::uint8_t, 2> factored = {0xff, 0xff};

    [[nodiscard]] bool is_active(std::size_t i) const { return (active_bits >> i & 1) != 0; }
    [[nodiscard]] bool is_barred(std::size_t i) const { return (barred_bits >> i & 1) != 0; }
  };
  struct Group {
    std::uint32_t first = 0;  // of contacts_
    std::uint32_t count = 0;
    std::array<std::uint32_t, 2> columns{};  // in each of the factors
    std::uint32_t first_body = 0;            // of bodies_
    std::uint32_t body_count = 0;
    std::int64_t most = 0;           // impulse of a point that is believed, m/s, Q32
    std::array<int, 2> exponents{};  // least of the rows that stand in each of the factors
    bool leans = false;              // on friction
    bool is_new = false;             // nothing in it has pushed yet
    bool holds = false;              // friction is solved along in the pass at hand
    bool is_filled = false;
    bool is_left = false;  // to the sweeps, for the rest of the tick

    // Those of the factors that the pass at hand solves with.
    [[nodiscard]] std::size_t which() const { return leans && !holds ? 1 : 0; }
    [[nodiscard]] int exponent() const { return exponents[which()]; }
  };

  // Which: direct_contacts.cpp.
  [[nodiscard]] bool is_pressed(const ContactRun& run, const Link& link, bool heavy_is_b) const;
  void gather(std::uint32_t light, std::size_t most);
  bool gather_all(std::size_t first, std::size_t most);
  bool gather_body(std::uint32_t body);
  void drop(std::size_t first);
  [[nodiscard]] bool is_squeezed(const ContactRun& run);
  void plan_group(const ContactRun& run, std::uint32_t root);
  bool plan_factor(Group& group);
  void list_bodies(const ContactRun& run, Group& group);
  static void take_over(const ContactRun& run, Contact& contact);
  // How: direct_solve.cpp, direct_push.cpp.
  static void give_back(const ContactRun& run, const Contact& contact);
  void read(const ContactRun& run, Contact& contact, bool pushes_out) const;
  static void choose_active(Contact& contact);
  static void flatten(Contact& contact);
  [[nodiscard]] static std::int64_t read_row(const ContactRun& run, const Contact& contact,
                                             const ContactRow& row);
  [[nodiscard]] static ProductSum read_linear(const ContactRun& run, const Contact& contact,
                                              const RawVec3& linear);
  [[nodiscard]] static std::int64_t read_turning(const ContactRun& run, const Contact& contact,
                                                 const ContactRow& row, ProductSum sum);
  // A body that two contacts share.
  struct Share {
    BlockFloat inverse_mass{};
    bool a_of_p = false, a_of_q = false;
  };
  struct Shares {
    std::array<Share, 4> all{};
    std::uint32_t count = 0;
  };
  [[nodiscard]] static Shares shares_of(const ContactRun& run, const Contact& p, const Contact& q);
  // Rows of a contact that stand in the factors: first those of points.
  struct Rows {
    std::array<const ContactRow*, k_factor_rows> all{};
    std::uint32_t count = 0, normals = 0;
  };
  [[nodiscard]] Rows all_rows_of(const Contact& contact) const;
  static void add_share(const Share& share, const Rows& p, const Rows& q, std::int64_t* to);
  void fill_block(const ContactRun& run, const Contact& p, const Contact& q,
                  std::int64_t* to) const;
  [[nodiscard]] const ContactRow& row_of(const Contact& contact, std::uint32_t r) const {
    if (r < contact.active) return contact.points[contact.order[r]];
    return ties_[contact.tie - 1].rows[r - contact.active];
  }
  // Whether its friction is solved in the pass at hand.
  [[nodiscard]] bool is_tied(const Contact& contact) const {
    return contact.tie != 0 && contact.active != 0 && ties_[contact.tie - 1].holds;
  }
  [[nodiscard]] std::uint32_t rows_of(const Contact& contact) const {
    return contact.active + (is_tied(contact) ? ties_[contact.tie - 1].count : 0);
  }
  [[nodiscard]] bool note_rows(const Group& group);
  void factor(const ContactRun& run, Group& group);
  [[nodiscard]] bool is_still(const ContactRun& run, const Group& group) const;
  void solve_group(const ContactRun& run, Group& group, bool pushes_out);
  [[nodiscard]] bool is_solved(const Group& group) const;
  void leave(const ContactRun& run, Group& group, bool pushes_out);
  bool try_once(const ContactRun& run, Group& group, bool pushes_out, bool is_last);
  bool find_changes(Group& group);
  void find_change(const Group& group, const Contact& contact, std::uint32_t rhs, ContactRow& row);

  using Impulses = std::array<std::int64_t, lanes::k_block_points>;
  void push_all(const ContactRun& run, const Group& group, bool only_lets_go);
  void push(const ContactRun& run, Contact& contact, const Impulses& next);
  void push_tie(const ContactRun& run, const Contact& contact);
  void give(const ContactRun& run, const Contact& contact, const RawVec3& force,
            const RawVec3& torque);
  void gain(const ContactRun& run, const Group& group);

  // Friction: direct_friction.cpp.
  [[nodiscard]] static std::int64_t push_of(const ContactRun& run, const Link& link);
  [[nodiscard]] static bool is_apart(const ContactRun& run, const Link& link, std::int64_t near);
  [[nodiscard]] bool leans(const ContactRun& run) const;
  static void fill_tie(const ContactRun& run, const Contact& contact, Tie& tie);
  void tie(const ContactRun& run, Contact& contact);
  void release(const ContactRun& run, Contact& contact);
  static void store_tie(const ContactRun& run, const Contact& contact, const Tie& tie);
  void hold_ties(Group& group, bool holds);
  [[nodiscard]] bool read_tie(const ContactRun& run, const Contact& contact);
  [[nodiscard]] bool is_stuck(const Contact& contact) const;
  [[nodiscard]] static bool slips(const Contact& contact, const Tie& tie);
  bool release_slipping(const ContactRun& run, Group& group);

  [[nodiscard]] std::span<JointFactor::Column> columns_of(const Group& group) {
    return factors_[group.which()].columns(group.columns[group.which()], group.count);
  }
  [[nodiscard]] std::span<Contact> contacts_of(const Group& group) {
    return std::span(contacts_).subspan(group.first, group.count);
  }

  std::vector<Link> links_;
  std::vector<std::uint32_t> left_out_;
  std::vector<Mark> marks_;       // by body
  std::vector<Mark> link_marks_;  // by link
  BodyLinks by_body_;
  std::vector<std::uint32_t> queue_;   // bodies
  std::vector<std::uint32_t> chosen_;  // links
  std::vector<std::uint32_t> order_;   // links of a group; by link: place in it
  std::vector<std::uint32_t> place_;
  std::vector<RawVec3> holds_;  // where what nothing moves pushes a group, Q30
  // What a body has yet to gain of impulses, m/s, Q32.
  struct Gain {
    RawVec3 velocity{}, spin{};
  };
  std::vector<std::uint32_t> bodies_;      // of all groups
  std::vector<Gain> gains_;                // of each of them
  std::vector<std::uint32_t> gain_place_;  // by body: where it is in both
  std::vector<Contact> contacts_;
  std::vector<Tie> ties_;
  std::vector<Group> groups_;
  // Of all groups; and without the friction of those that lean on it, since passes with friction
  // and without take turns.
  std::array<JointFactor, 2> factors_;
};

}  // namespace lockstone
