#pragma once

#include <tendril/contact/rod_contact.h>
#include <tendril/dynamics/state.h>

namespace tendril::contact::test {

/// What rods' contact with solids was at a state, where it is the scene's force of that index.
inline const ContactMemory& memory_of(const State& state, std::size_t force = 0) {
  return dynamic_cast<const ContactMemory&>(*state.memory.at(force));
}

}  // namespace tendril::contact::test
