//! Rows of the validation page: the response of the rotor.

mod blade_loads;
mod hinge;
mod hover_torque;
mod joints;
mod march;
mod planform;
mod rotor;
mod rotor_details;
mod study_work;
mod tables;

use validation::hold;

#[test]
fn blade_loads_rows() {
    hold(blade_loads::ROWS);
}

#[test]
fn hover_torque_rows() {
    hold(hover_torque::ROWS);
}

#[test]
fn joints_rows() {
    hold(joints::ROWS);
}

#[test]
fn march_rows() {
    hold(march::ROWS);
}

#[test]
fn planform_rows() {
    hold(planform::ROWS);
}

#[test]
fn rotor_rows() {
    hold(rotor::ROWS);
}

#[test]
fn rotor_details_rows() {
    hold(rotor_details::ROWS);
}

#[test]
fn study_work_rows() {
    hold(study_work::ROWS);
}

#[test]
fn tables_rows() {
    hold(tables::ROWS);
}

#[test]
fn moderate_deflections_rows() {
    hold(rotor::MODERATE);
}
