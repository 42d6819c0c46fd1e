/* events.h: the events of an iteration: contacts, creation and end of objects, announcements, sleep. A part of breve.h,
 * whose rules hold here.
 */
#ifndef BREVE_EVENTS_H
#define BREVE_EVENTS_H

#include "breve/breve.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- events ------------------------------------------------------------------------------------------------------ */

/* The host selects the kinds of events that it wants. The lists of an iteration are valid from its end until the next one
   begins or an image is restored. Only the selected kinds are collected; the effect "events" reports whether any are, and
   what they cost. Events are not part of the world: neither the hash nor images contain them.
   breve_world_interventions lists the actions of the guard, and breve_world_impacts the impulses alone. Objects in these
   lists may have been freed; their ids are stale then. */

/* Kinds of events; add them to select several. */
typedef enum breve_event {
  BREVE_EVENT_CONTACT = 1,      /* see breve_world_watch_contacts */
  BREVE_EVENT_LIFE = 2,         /* objects that were created or freed */
  BREVE_EVENT_ANNOUNCEMENT = 4, /* `announce`, whether an object observes it or not */
  BREVE_EVENT_SLEEP = 8         /* bodies that fall asleep or wake up; requires breve_world_set_sleeping */
} breve_event;

/* Selects the kinds of events that are collected from now on.
   @param kinds  a sum of breve_event; 0: none
   BREVE_OK; BREVE_ERROR_ARGUMENT: a bit that is not a breve_event. */
BREVE_API breve_status breve_world_set_events(breve_world* world, uint32_t kinds);

/* The kinds that are collected. 0 for NULL. */
BREVE_API uint32_t breve_world_events(const breve_world* world);

/* Starts or stops reporting the contacts of all objects of a class and its descendants. After a reload
   (breve_world_reload) that gives a class new descendants, call it again.
   BREVE_OK; BREVE_ERROR_NOT_FOUND: the program does not have the class. */
BREVE_API breve_status breve_world_watch_contacts(breve_world* world, const char* class_name, bool on);

/* Starts or stops reporting the contacts of one object. BREVE_OK; BREVE_ERROR_NO_BODY. */
BREVE_API breve_status breve_object_watch_contacts(breve_world* world, breve_object object, bool on);

/* Whether the contacts of an object are reported, because it or its class is watched. BREVE_OK; BREVE_ERROR_NO_BODY. */
BREVE_API breve_status breve_object_contacts_watched(const breve_world* world, breve_object object, bool* watched);

typedef enum breve_phase {
  BREVE_PHASE_BEGIN = 0,   /* they did not touch at the end of the last iteration */
  BREVE_PHASE_PERSIST = 1, /* they still touch */
  BREVE_PHASE_END = 2      /* they no longer touch */
} breve_phase;

/* Two bodies that touch at the end of an iteration, or that collided during it. A contact begins when the gap is at most
   1e-4 of the smaller radius and ends when it exceeds 1e-3, so that a body at rest does not flicker between the two.
   Bodies without physics that meet and part within one iteration are not reported. Frozen. */
typedef struct breve_contact {
  uint32_t phase; /* breve_phase */
  uint32_t reserved;
  breve_object a, b; /* a was created earlier */
  double point[3];   /* midway between their nearest (or deepest) points, world frame. In BREVE_PHASE_END: the last one */
  double normal[3];  /* unit, from b toward a; in BREVE_PHASE_END: the last one */
  double distance;   /* negative: the depth of the overlap; in BREVE_PHASE_END: the last one */
  double impulse[3]; /* on a, N*s: the sum of the impacts of this iteration (breve_world_impacts). The support of a body
                        that rests is not an impact */
} breve_contact;

/* The contacts of the last iteration, in the order of creation of a, then of b.
   @param contacts  room for `capacity` contacts; NULL only if capacity is 0
   @param count     the total number, even if it exceeds capacity; at most capacity contacts are written
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

/* An object that was created or freed. Frozen. */
typedef struct breve_life {
  breve_object object;
  const char* class_name; /* owned by the program */
  bool born;              /* created; false: freed */
} breve_life;

/* Objects that were created or freed, in that order in time. As breve_world_contacts. The list also contains events between
   two iterations, until the next iteration begins. */
BREVE_API breve_status breve_world_lives(const breve_world* world, breve_life* lives, size_t capacity, size_t* count);

/* An announcement of an object. Frozen. */
typedef struct breve_announcement {
  breve_object announcer;
  double time;         /* s */
  const char* message; /* owned by the world until the next iteration begins */
} breve_announcement;

/* Announcements, in the order in which they were made. As breve_world_lives. */
BREVE_API breve_status breve_world_announcements(const breve_world* world, breve_announcement* announcements,
                                                 size_t capacity, size_t* count);

/* A body that fell asleep or woke up during the iteration. Frozen. */
typedef struct breve_nap {
  breve_object object;
  bool asleep;
} breve_nap;

/* Bodies that woke up, then bodies that fell asleep, each in the order of creation. As breve_world_contacts. */
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
