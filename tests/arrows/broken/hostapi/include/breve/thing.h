/* thing.h: functions whose comments name too few statuses. */
#ifndef BREVE_THING_H
#define BREVE_THING_H

/* ---- things ---- */

/* The size of a thing. BREVE_OK; BREVE_ERROR_TYPE. The same below. */
BREVE_API breve_status breve_thing_size(const breve_thing* thing, size_t* size);

/* Names everything, by a word of its section and by another function. As breve_thing_size; BREVE_ERROR_BUSY. */
BREVE_API breve_status breve_thing_lock(breve_thing* thing);

/* ---- others ---- */

/* The helper's status is missing. BREVE_OK; BREVE_ERROR_BUSY. */
BREVE_API breve_status breve_other_lock(breve_other* other);

#endif
