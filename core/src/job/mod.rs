//! One frame, and many.
