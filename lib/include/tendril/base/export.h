#pragma once

/// What a shared library shows. Everything is built with hidden symbols (-fvisibility=hidden); a class or
/// function that a component's users link to carries that component's mark: its functions, its typeinfo (so
/// that what one library throws is caught in another) and its vtable. TENDRIL_SHARED is a definition that the
/// CMake targets of a shared build hand on.
#ifdef TENDRIL_SHARED
#define TENDRIL_VISIBLE __attribute__((visibility("default")))
#else
#define TENDRIL_VISIBLE
#endif

#define TENDRIL_CORE_API TENDRIL_VISIBLE
#define TENDRIL_SCENE_API TENDRIL_VISIBLE
#define TENDRIL_BIND_API TENDRIL_VISIBLE
#define TENDRIL_AXIS_API TENDRIL_VISIBLE
#define TENDRIL_COLLISION_API TENDRIL_VISIBLE
#define TENDRIL_EXACT_API TENDRIL_VISIBLE
#define TENDRIL_CONTACT_API TENDRIL_VISIBLE
