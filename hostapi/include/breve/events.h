/* events.h: what happened in an iteration, as lists: contacts, births and deaths, announcements, who sleeps. A part of breve.h,
 * whose rules hold here.
 */
#ifndef BREVE_EVENTS_H
#define BREVE_EVENTS_H

#include "breve/breve.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- events ------------------------------------------------------------------------------------------------------ */

/* A host says which events it wants; the lists of an iteration are there from its end until the next one begins, or one is
   restored. Only events that were asked for are gathered: the effect "events" says whether there are any, and what
   they cost. Events are not part of the world: neither the hash nor images contain them. breve_world_interventions lists
   what the guard did, and breve_world_impacts the impulses alone. Objects in these lists may be gone; their ids then
   are stale. */

/* Kinds of events, to be added. */
typedef enum breve_event {
  BREVE_EVENT_CONTACT = 1,      /* see breve_world_watch_contacts */
  BREVE_EVENT_LIFE = 2,         /* births and deaths */
  BREVE_EVENT_ANNOUNCEMENT = 4, /* `announce`, whether somebody observes it or not */
  BREVE_EVENT_SLEEP = 8         /* bodies that fall asleep or wake; there are none before breve_world_set_sleeping */
} breve_event;

/* Gather events of these kinds, of breve_event added, from now on; 0: none.
   BREVE_OK; BREVE_ERROR_ARGUMENT: a bit that is not a breve_event. */
BREVE_API breve_status breve_world_set_events(breve_world* world, uint32_t kinds);

/* The kinds that are gathered; 0 for NULL. */
BREVE_API uint32_t breve_world_events(const breve_world* world);

/* Report the contacts of all objects of a class and its descendants, with anything, or stop that. Classes that a later
   program (breve_world_reload) gives descendants are to be named again.
   BREVE_OK; BREVE_ERROR_NOT_FOUND: the program has no such class. */
BREVE_API breve_status breve_world_watch_contacts(breve_world* world, const char* class_name, bool on);

/* Report the contacts of one object, or stop that. BREVE_OK; BREVE_ERROR_NO_BODY. */
BREVE_API breve_status breve_object_watch_contacts(breve_world* world, breve_object object, bool on);

/* Are the contacts of an object reported, because it or its class is watched? BREVE_OK; BREVE_ERROR_NO_BODY. */
BREVE_API breve_status breve_object_contacts_watched(const breve_world* world, breve_object object, bool* watched);

typedef enum breve_phase {
  BREVE_PHASE_BEGIN = 0,   /* they did not touch at the end of the last iteration */
  BREVE_PHASE_PERSIST = 1, /* they still touch */
  BREVE_PHASE_END = 2      /* they do not touch any more */
} breve_phase;

/* Two bodies that touch at the end of the iteration, or between which an impact was in it. To touch, a gap of 1e-4 of the
   smaller one's radius is enough; a contact ends at 1e-3, so that what rests does not tremble between the two. Bodies
   without physics that meet and part again within one iteration are not seen. Frozen. */
typedef struct breve_contact {
  uint32_t phase; /* breve_phase */
  uint32_t reserved;
  breve_object a, b; /* a was created earlier */
  double point[3];   /* midway between their nearest, or deepest, points; world frame. In BREVE_PHASE_END the last */
  double normal[3];  /* unit, from b toward a; likewise */
  double distance;   /* < 0: the depth of the overlap; likewise */
  double impulse[3]; /* on a, N*s: the sum of the impacts of this iteration (breve_world_impacts). The support of a body
                        that rests is not an impact */
} breve_contact;

/* The contacts of the last iteration, in the order of creation of a, then of b.
   @param contacts  room for `capacity`; NULL only if capacity is 0
   @param count     how many there are, also where that is more than capacity: at most capacity are written
   BREVE_OK. */
BREVE_API breve_status breve_world_contacts(const breve_world* world, breve_contact* contacts, size_t capacity,
                                            size_t* count);

/* The force that a contact carried in the last sub-step, on `object`, N, world frame: for a body of mass m that rests on
   a floor, m g upward. It is the impulse of the contact, friction included, divided by the length of the sub-step; at an
   impact it is large. A body that sleeps keeps the force with which it fell asleep. On rungs whose resting contacts are
   springs (breve_accuracy.contact_springs), the force of these springs. No contacts have to be watched, and nothing is
   gathered for it. Bodies without physics carry no force between them.
   @param other  null: the sum over all bodies that touch `object`, as on a scale or a pressure plate
   BREVE_OK, with 0 if they do not touch; BREVE_ERROR_NO_BODY; BREVE_ERROR_ARGUMENT: both are the same object. */
BREVE_API breve_status breve_object_contact_force(const breve_world* world, breve_object object, breve_object other,
                                                  double force[3]);

/* An object that was made or freed. Frozen. */
typedef struct breve_life {
  breve_object object;
  const char* class_name; /* owned by the program */
  bool born;              /* else it is gone */
} breve_life;

/* In the order in which it happened. As breve_world_contacts. What happens between iterations is in the list as well, from
   when it happens until the next one begins. */
BREVE_API breve_status breve_world_lives(const breve_world* world, breve_life* lives, size_t capacity, size_t* count);

/* What an object announced. Frozen. */
typedef struct breve_announcement {
  breve_object announcer;
  double time;         /* s */
  const char* message; /* owned by the world until the next iteration begins */
} breve_announcement;

/* In the order in which they were made. As breve_world_lives. */
BREVE_API breve_status breve_world_announcements(const breve_world* world, breve_announcement* announcements,
                                                 size_t capacity, size_t* count);

/* A body that fell asleep or woke in the iteration. Frozen. */
typedef struct breve_nap {
  breve_object object;
  bool asleep;
} breve_nap;

/* Those that woke, then those that fell asleep, each in the order of creation. As breve_world_contacts. */
BREVE_API breve_status breve_world_naps(const breve_world* world, breve_nap* naps, size_t capacity, size_t* count);

/* ---- callbacks ---------------------------------------------------------------------------------------------------- */

/* Functions of a host that get the events during an iteration, one by one, in the order of the lists: no event is lost
   when breve_world_advance runs several iterations. A function that is not NULL also asks for its kind of event, as
   breve_world_set_events does; contacts are those of watched objects.
   - `life`, `announcement` and `intervention` are called as soon as the handler, `iterate` or other call by the world in
     which the event happened has returned; `contact` and `nap` at the end of the iteration, when they are known. Events
     between two iterations, and those after an error that ended an iteration, come when the next one begins.
   - The functions may call any function of this header, and change the world as a script would in its `iterate`: create
     and free objects, move them, call methods. Functions that cannot work inside an iteration, such as
     breve_world_step, _restore, _snapshot, _destroy and breve_world_set_listener, return BREVE_ERROR_BUSY and do
     nothing. Events that a callback itself causes are reported later, never from inside it.
   - A callback that changes the world is a part of the run: a replay (breve_world_replay) agrees only with the same
     listener. Callbacks that only read leave no trace in the world. */
typedef struct breve_listener {
  size_t struct_size; /* set by breve_listener_default */
  void* user;         /* passed to the functions. Default NULL */
  /* Each may be NULL: it is not called. Structs and texts are valid until the function returns. Default NULL */
  void (*contact)(void* user, breve_world* world, const breve_contact* contact);
  void (*life)(void* user, breve_world* world, const breve_life* life);
  void (*announcement)(void* user, breve_world* world, const breve_announcement* announcement);
  void (*nap)(void* user, breve_world* world, const breve_nap* nap);
  void (*intervention)(void* user, breve_world* world, const breve_intervention* intervention);
} breve_listener;

/* The defaults named above. */
static inline breve_listener breve_listener_default(void) {
  breve_listener listener;
  breve_clear(&listener, sizeof listener);
  listener.struct_size = sizeof listener;
  return listener;
}

/* Sets the callbacks of a world. They get the events from now on. They are not part of images.
   @param listener  copied; NULL: none
   BREVE_OK; BREVE_ERROR_ARGUMENT: a wrong struct_size; BREVE_ERROR_BUSY while a script of this world runs. */
BREVE_API breve_status breve_world_set_listener(breve_world* world, const breve_listener* listener);

/* The callbacks that were set, or the defaults. BREVE_OK; BREVE_ERROR_ARGUMENT: a wrong struct_size. */
BREVE_API breve_status breve_world_listener(const breve_world* world, breve_listener* listener);

#ifdef __cplusplus
}
#endif

#endif
