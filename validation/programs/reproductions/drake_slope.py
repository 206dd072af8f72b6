"""A sled under the load of a slope of tangent 0.45, mu = 0.5: the speed at which it creeps, after 0.5 s on the level."""

import pydrake.all as d

for model, kind in ("point", "sap"), ("point", "similar"), ("point", "lagged"), ("point", "tamsi"), ("hydroelastic", "lagged"):
    plant, _ = d.AddMultibodyPlant(d.MultibodyPlantConfig(time_step=0.001, contact_model=model, discrete_contact_approximation=kind), builder := d.DiagramBuilder())
    sled = plant.AddRigidBody("sled", d.SpatialInertia(0.3, [0, 0, 0], d.UnitInertia(1 / 300, 1 / 300, 1 / 150)))
    d.AddCompliantHydroelasticProperties(0.01, 1e7, soft := d.ProximityProperties())
    d.AddRigidHydroelasticProperties(0.01, hard := d.ProximityProperties())
    for body, xyz, shape, has in [(plant.world_body(), [0, 0, -0.02], d.HalfSpace(), hard)] + [(sled, [x, y, -0.01], d.Sphere(0.01), soft) for x in (-0.1, 0.1) for y in (-0.1, 0.1)]:
        has.UpdateProperty("material", "coulomb_friction", d.CoulombFriction(0.5, 0.5))
        plant.RegisterCollisionGeometry(body, d.RigidTransform(xyz), shape, f"{shape} {xyz}", has)
    simulator = d.Simulator(plant.Finalize() or builder.Build())
    context = plant.GetMyMutableContextFromRoot(simulator.get_mutable_context())
    simulator.AdvanceTo(0.5)
    plant.get_applied_generalized_force_input_port().FixValue(context, [0, 0, 0, 1.2077, 0, 0.25922])  # 0.3 9.81 (sin a, 0, 1 - cos a)
    simulator.AdvanceTo(1.0)
    print(f"{model}, {kind}: {1e6 * plant.GetVelocities(context)[3]:.3g} um/s (Coulomb: 0)")
