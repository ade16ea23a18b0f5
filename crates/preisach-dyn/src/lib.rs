//! Hysteretic piezo actuators: static and dynamic Preisach models, identification from bench records, periodic response.
