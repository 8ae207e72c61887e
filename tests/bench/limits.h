#pragma once

#include <cstddef>

/// What the machine itself can do, as a measure for the rest.
namespace tendril::bench {

/// Nanoseconds for moving the bytes a node of a twistless state has (48 in, 48 out), by a = b + s c on arrays
/// of the same size.
double bytes_ns(std::size_t nodes);

/// Nanoseconds a node of the plainest chain: arrays per coordinate, stretch along edges, bending by the
/// fourth difference, rates of positions and velocities; no frames, no twist, no forces, no checks.
double plain_chain_ns(std::size_t nodes);

}  // namespace tendril::bench
