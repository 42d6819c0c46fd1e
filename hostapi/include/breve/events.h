/* events.h: reports the events of an iteration: contacts, the creation and freeing of objects, announcements, and sleep. It
 * is a part of breve.h, and the rules at the top of breve.h hold here.
 */
#ifndef BREVE_EVENTS_H
#define BREVE_EVENTS_H

#include "breve/breve.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- events ------------------------------------------------------------------------------------------------------ */

/* The host selects the kinds of events that it wants, and reads them as lists. The lists of an iteration are valid from its
   end until the next iteration begins or an image is restored. The world collects only the selected kinds; the effect
   "events" reports whether it collects any, and what they cost. Events are not part of the world: neither the hash nor
   images contain them. breve_world_interventions lists the actions of the guard, and breve_world_impacts lists the
   impulses alone. An object in these lists may have been freed; its id is then stale. */

/* The kinds of events; add them to select several. */
typedef enum breve_event {
  BREVE_EVENT_CONTACT = 1,      /* see breve_world_watch_contacts */
  BREVE_EVENT_LIFE = 2,         /* objects that were created or freed */
  BREVE_EVENT_ANNOUNCEMENT = 4, /* `announce`, whether an object observes it or not */
  BREVE_EVENT_SLEEP = 8         /* bodies that fall asleep or wake up; requires breve_world_set_sleeping */
} breve_event;

/* Selects the kinds of events that are collected from now on.
   @param kinds  a sum of breve_event values; 0: none
   BREVE_OK; BREVE_ERROR_ARGUMENT: kinds has a bit that is not a breve_event. */
BREVE_API breve_status breve_world_set_events(breve_world* world, uint32_t kinds);

/* Returns the kinds of events that are collected. Returns 0 for NULL. */
BREVE_API uint32_t breve_world_events(const breve_world* world);

/* Starts or stops reporting the contacts of all objects of a class and its descendants. After a reload
   (breve_world_reload) that gives a class new descendants, call it again.
   BREVE_OK; BREVE_ERROR_NOT_FOUND: the program does not have the class. */
BREVE_API breve_status breve_world_watch_contacts(breve_world* world, const char* class_name, bool on);

/* Starts or stops reporting the contacts of one object. BREVE_OK; BREVE_ERROR_NO_BODY. */
BREVE_API breve_status breve_object_watch_contacts(breve_world* world, breve_object object, bool on);

/* Reads whether the contacts of an object are reported, because the object or its class is watched. BREVE_OK;
   BREVE_ERROR_NO_BODY. */
BREVE_API breve_status breve_object_contacts_watched(const breve_world* world, breve_object object, bool* watched);

/* The phase of a contact between two bodies. */
typedef enum breve_phase {
  BREVE_PHASE_BEGIN = 0,   /* the bodies did not touch at the end of the last iteration */
  BREVE_PHASE_PERSIST = 1, /* the bodies still touch */
  BREVE_PHASE_END = 2      /* the bodies no longer touch */
} breve_phase;

/* A contact of two bodies that touch at the end of an iteration, or that collided during it. A contact begins when the gap
   is at most 1e-4 of the smaller radius, and ends when the gap exceeds 1e-3 of it, so that the contact of a body at rest
   does not begin and end over and over. Two bodies without physics that meet and part within one iteration are not
   reported. Frozen. */
typedef struct breve_contact {
  uint32_t phase; /* breve_phase */
  uint32_t reserved;
  breve_object a, b; /* a was created earlier */
  double point[3];   /* midway between their nearest (or deepest) points, world frame. In BREVE_PHASE_END: the last point */
  double normal[3];  /* unit length, from b toward a. In BREVE_PHASE_END: the last normal */
  double distance;   /* negative: the depth of the overlap. In BREVE_PHASE_END: the last distance */
  double impulse[3]; /* on a, N*s: the sum of the impacts of this iteration (breve_world_impacts). The force that supports
                        a resting body is not an impact */
} breve_contact;

/* Reads the contacts of the last iteration, in the order of creation of a, then of b.
   @param contacts  room for `capacity` contacts; NULL only if capacity is 0
   @param count     receives the total number, even if it exceeds capacity; at most capacity contacts are written
   BREVE_OK. */
BREVE_API breve_status breve_world_contacts(const breve_world* world, breve_contact* contacts, size_t capacity,
                                            size_t* count);

/* Reads the force that a contact exerted on `object` in the last sub-step, N, world frame. For a body of mass m that rests
   on a floor, it is m g upward. The force is the impulse of the contact, including friction, divided by the length of the
   sub-step; at an impact it is large. On rungs whose resting contacts are springs (breve_accuracy.contact_springs), it is
   the force of these springs. A body that sleeps keeps the force with which it fell asleep. The contacts do not have to be
   watched, and the world does not collect anything for this function. Bodies without physics do not exert forces on each
   other.
   @param other  null: the sum over all bodies that touch `object`, as on a scale or a pressure plate
   BREVE_OK, with a force of 0 if the bodies do not touch; BREVE_ERROR_NO_BODY; BREVE_ERROR_ARGUMENT: both are the same
   object. */
BREVE_API breve_status breve_object_contact_force(const breve_world* world, breve_object object, breve_object other,
                                                  double force[3]);

/* An object that was created or freed. Frozen. */
typedef struct breve_life {
  breve_object object;
  const char* class_name; /* owned by the program */
  bool born;              /* created; false: freed */
} breve_life;

/* Reads the objects that were created or freed, in the order in which this happened. The list also contains objects that
   were created or freed after the iteration, until the next iteration begins. Takes the same parameters and returns the
   same statuses as breve_world_contacts. */
BREVE_API breve_status breve_world_lives(const breve_world* world, breve_life* lives, size_t capacity, size_t* count);

/* An announcement of an object. Frozen. */
typedef struct breve_announcement {
  breve_object announcer;
  double time;         /* s */
  const char* message; /* owned by the world until the next iteration begins */
} breve_announcement;

/* Reads the announcements, in the order in which they were made. The list also contains announcements that
   were made after the iteration. Takes the same parameters and returns the same statuses as breve_world_contacts. */
BREVE_API breve_status breve_world_announcements(const breve_world* world, breve_announcement* announcements,
                                                 size_t capacity, size_t* count);

/* A body that fell asleep or woke up during the iteration. Frozen. */
typedef struct breve_nap {
  breve_object object;
  bool asleep;
} breve_nap;

/* Reads the bodies that woke up, then the bodies that fell asleep, each group in the order of creation. Takes the same
   parameters and returns the same statuses as breve_world_contacts. */
BREVE_API breve_status breve_world_naps(const breve_world* world, breve_nap* naps, size_t capacity, size_t* count);

/* ---- callbacks ---------------------------------------------------------------------------------------------------- */

/* Functions of a host that receive the events during an iteration, one by one, in the order of the lists. No event is lost
   when breve_world_advance runs several iterations. A function that is not NULL also selects its kind of event, as
   breve_world_set_events does. Contacts are reported for watched objects only.
   - The world calls `life`, `announcement` and `intervention` as soon as the handler, `iterate` or other call by the world
     in which the event happened has returned. It calls `contact` and `nap` at the end of the iteration, when these events
     are known. Events between two iterations, and events after an error that ended an iteration, are reported when the
     next iteration begins.
   - The functions may call any function of this header, and change the world as a script may in its `iterate`: create
     and free objects, move them, and call methods. Functions that cannot work inside an iteration, such as
     breve_world_step, _restore, _snapshot, _destroy and breve_world_set_listener, return BREVE_ERROR_BUSY and do
     nothing. Events that a callback itself causes are reported later, never from inside it.
   - A callback that changes the world is a part of the run: a replay (breve_world_replay) agrees with the run only if the
     same listener is set. Callbacks that only read do not affect the world. */
typedef struct breve_listener {
  size_t struct_size; /* set by breve_listener_default */
  void* user;         /* passed to the functions. Default NULL */
  /* A function that is NULL is not called. Structs and texts are valid until the function returns. Default NULL */
  void (*contact)(void* user, breve_world* world, const breve_contact* contact);
  void (*life)(void* user, breve_world* world, const breve_life* life);
  void (*announcement)(void* user, breve_world* world, const breve_announcement* announcement);
  void (*nap)(void* user, breve_world* world, const breve_nap* nap);
  void (*intervention)(void* user, breve_world* world, const breve_intervention* intervention);
} breve_listener;

/* Returns a listener with the defaults named above. */
static inline breve_listener breve_listener_default(void) {
  breve_listener listener;
  breve_clear(&listener, sizeof listener);
  listener.struct_size = sizeof listener;
  return listener;
}

/* Sets the callbacks of a world, which receive all events from now on. Images do not contain the callbacks.
   @param listener  copied; NULL: none
   BREVE_OK; BREVE_ERROR_ARGUMENT: a wrong struct_size; BREVE_ERROR_BUSY while a script of this world runs. */
BREVE_API breve_status breve_world_set_listener(breve_world* world, const breve_listener* listener);

/* Reads the callbacks that were set, or the defaults. BREVE_OK; BREVE_ERROR_ARGUMENT: a wrong struct_size. */
BREVE_API breve_status breve_world_listener(const breve_world* world, breve_listener* listener);

#ifdef __cplusplus
}
#endif

#endif
