#include <algorithm>
#include <limits>
#include <string>

#include "math/vec.h"
#include "plant/channels.h"

namespace taut::plant {
namespace {

constexpr std::size_t kPerContact = 9;

std::vector<ChannelInfo> NamesOf(int slots) {
  std::vector<ChannelInfo> names;
  for (int k = 0; k < slots; ++k) {
    const auto add = [&](const char* name, const char* unit) {
      names.push_back({std::to_string(k) + "/" + name, unit});
    };
    for (const char* const name : {"body_a", "body_b"}) add(name, "1");
    for (const char* const name : {"point_x_m", "point_y_m", "point_z_m"}) add(name, "m");
    for (const char* const name : {"force_x_n", "force_y_n", "force_z_n"}) add(name, "N");
    add("gap_m", "m");
  }
  return names;
}

/// Reduces `contacts` to the `room` contacts with the largest forces, in their original order.
void LeaveLargest(std::vector<ContactState>& contacts, std::size_t room) {
  if (contacts.size() <= room) return;
  std::vector<std::size_t> order(contacts.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    const Vec3 &f = contacts[a].force_n, &g = contacts[b].force_n;
    return Dot(f, f) > Dot(g, g);
  });
  order.resize(room);
  std::sort(order.begin(), order.end());
  for (std::size_t i = 0; i < room; ++i) contacts[i] = contacts[order[i]];
  contacts.resize(room);
}

}  // namespace

void AddContactChannels(const ExperimentSpec& experiment, Recorder& recorder) {
  const int slots = experiment.record.contacts;
  if (slots <= 0) return;
  const auto room = static_cast<std::size_t>(slots);
  recorder.AddAsked("contact/", NamesOf(slots),
                    [room, &recorder](const RecordSource& s, double* out) {
                      std::vector<ContactState> contacts = s.world->Contacts(s.lane);
                      recorder.CountContacts(contacts.size(), room);
                      LeaveLargest(contacts, room);
                      for (const ContactState& contact : contacts) {
                        out[0] = contact.body_a;
                        out[1] = contact.body_b;
                        Put(contact.point_m, out + 2);
                        Put(contact.force_n, out + 5);
                        out[8] = contact.gap_m;
                        out += kPerContact;
                      }
                      std::fill_n(out, kPerContact * (room - contacts.size()),
                                  std::numeric_limits<double>::quiet_NaN());
                    });
}

}  // namespace taut::plant
