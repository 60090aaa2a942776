% Checks of microslip.mex and microslip_residual; the last line is "N passed, N failed".
function run
    addpath(fileparts(fileparts(mfilename('fullpath'))));
    response();
    gradients();
    elements_of_nlvib();
    errors();
    check();
end

% check(name, value, largest): counts; without arguments prints the counts and ends the program.
function check(name, value, largest)
    persistent passed failed
    if isempty(passed)
        passed = 0;
        failed = 0;
    end
    if nargin == 0
        printf('%d passed, %d failed\n', passed, failed);
        exit(double(failed > 0));
    elseif all(value <= largest)
        passed = passed + 1;
        printf('passed: %s: %.1e\n', name, max(value));
    else
        failed = failed + 1;
        printf('FAILED: %s: %.1e, allowed are %.1e\n', name, max(value), largest);
    end
end

% The contact of fortran_examples/cases/two_dof.nml.
function p = parameters()
    p = struct('flat_half_width', 0.2e-3, 'edge_radius', 5e-3, 'length', 10e-3, 'normal_force', 150, ...
               'friction_coefficient', 0.4, 'young_modulus', 114e9, 'poisson_ratio', 0.32, 'displacement_reference', 1);
end

% The system of two_dof.nml, with the given contacts between the second mass and the ground.
function system = two_dof(elements)
    system = struct('M', diag([1, 0.5]), 'D', [30, -10; -10, 10], 'K', [2.5e7, -2e7; -2e7, 2.1e7], 'Fex1', [15; 0]);
    system.nonlinear_elements = elements;
end

% The forced response that fortran_examples computes, at its frequencies: 1e-12 of the displacement of the contact is the tolerance of
% its residual, which the response amplifies by up to 10.
function response()
    root = fullfile(fileparts(mfilename('fullpath')), '..', '..', '..');
    expected = dlmread(fullfile(root, 'fortran_examples', 'expected', 'two_dof.csv'), ',', 1, 0);
    contact = struct('type', 'microslip', 'object', microslip('contact', parameters()), 'force_direction', [0; 1]);
    % A normal force of 150 N that does not depend on the displacement: the same law, by the element, whose normal input is
    % MSLIP_INPUT_NORMAL_FORCE, 17.
    element = struct('type', 'microslip', 'object', microslip('element', parameters(), 1, 17), ...
                     'force_direction', [0, 0; 1, 0], 'offset', [0, 150]);
    check('forced response of two_dof.nml', difference(two_dof({contact}), expected), 1e-11);
    check('forced response, by an element under the same load', difference(two_dof({element}), expected), 1e-11);
    contact.force_direction = [0; 0.9];
    check('another direction has another response', 1e-3/difference(two_dof({contact}), expected), 1);
end

% Largest correction of the coefficients by Newton's method, relative to the largest one of the frequency.
function worst = difference(system, expected)
    worst = 0;
    for i = 1:2:rows(expected)
        x = reshape(expected(i:i+1, 3:13), [], 1);
        [R, dR] = microslip_residual([x; 2*pi*expected(i,1)], system, 5, 128, 'frf');
        worst = max(worst, max(abs(dR(:,1:end-1)\R))/max(abs(x)));
    end
end

% Derivatives by central differences of the residual. Steps of 1e-6 of the displacement lose ten of sixteen digits; with longer
% ones points of the contact in two directions change between stick and slip.
function gradients()
    H = 3;
    rng = @(seed, m) sin(seed*(1:m).'.^2);
    q = microslip('element', parameters(), 1, 16);
    press = microslip('approach', q, 150);
    varying = struct('type', 'microslip', 'object', q, 'force_direction', [1, 0.3; -0.2, 1], 'offset', [0, press]);
    plane = struct('type', 'microslip', 'object', microslip('element', parameters(), 2, 16), ...
                   'force_direction', [1, 0, 0.2; 0, 1, 0.3], 'offset', [0, 0, press]);
    contact = struct('type', 'microslip', 'object', microslip('contact', parameters()), 'force_direction', [1; -1]);
    x = 5e-7*rng(1.1, 2*(2*H + 1));
    response = @(elements) @(X) microslip_residual(X, two_dof(elements), H, 64, 'frf');
    derivative('two elements and a contact', response({varying, contact, varying}), [x; 4000]);
    derivative('an element of two directions', response({plane}), [x; 4000]);
    modal = @(X) microslip_residual(X, two_dof({varying, contact}), H, 64, 'nma', 1, 1e6);
    derivative('modal analysis', modal, [x*1e6; 4000; 0.01; -6]);

    % The energy per period is the work of the harmonics of force and displacement.
    displacement = [0, press; 6e-7, 0; 0, 2e-7; 1e-7, 0; 0, 1e-7];
    [force, ~, dissipated] = microslip('harmonic_force', q, 64, displacement);
    work = 0;
    for k = 1:2
        work = work + pi*k*sum(force(2*k,:).*displacement(2*k+1,:) - force(2*k+1,:).*displacement(2*k,:));
    end
    check('energy against the work of the harmonics', abs(work/dissipated - 1), 1e-12);
end

function derivative(name, residual, X)
    [R, dR] = residual(X);
    worst = 0;
    for i = 1:numel(X)
        h = 1e-6*max(abs(X(i)), 0.1*max(abs(X(1:end-3))));
        forward = X;
        back = X;
        forward(i) = X(i) + h;
        back(i) = X(i) - h;
        differences = (residual(forward) - residual(back))/(forward(i) - back(i));
        worst = max(worst, max(abs(differences - dR(:,i)))/max(abs(dR(:,i))));
    end
    check(['derivatives by differences: ', name], worst, 1e-6);
end

% Elements of NLvib in the same system, if NLvib is there.
function elements_of_nlvib()
    if isempty(which('solve_and_continue')) % the stand-in
        return
    end
    slider = struct('type', 'elasticDryFriction', 'stiffness', 1e8, 'friction_limit_force', 60, 'ishysteretic', true, ...
                    'islocal', true, 'force_direction', [1; 0]);
    contact = struct('type', 'microslip', 'object', microslip('contact', parameters()), 'force_direction', [0; 1]);
    X = [1e-6*sin((1:14).'.^2); 4000];
    residual = @(elements) microslip_residual(X, two_dof(elements), 3, 64);
    none = HB_residual(X, two_dof({}), 3, 64, 'frf');
    both = residual({slider, contact});
    apart = residual({contact}) + HB_residual(X, two_dof({slider}), 3, 64) - none;
    check('elements of NLvib beside a contact', norm(both - apart)/norm(both), 1e-14);
end

function errors()
    p = parameters();
    contact = microslip('contact', p);
    element = microslip('element', p);
    force = @(object, samples, displacement) @() microslip('harmonic_force', object, samples, displacement);
    none = zeros(3, 1);
    rejected('friction_coefficient must be', @() microslip('contact', setfield(p, 'friction_coefficient', -1)));
    rejected('length must be', @() microslip('contact', rmfield(p, 'length')));
    rejected('unknown parameter radius', @() microslip('contact', setfield(p, 'radius', 1)));
    rejected('directions must be', @() microslip('element', p, 3));
    rejected('invalid contact', force(zeros(size(contact), 'uint8'), 64, none));
    rejected('neither a contact nor an element', force(1, 64, none));
    rejected('samples', force(contact, 6, zeros(7, 1)));
    rejected('2H+1 rows', force(contact, 64, zeros(4, 1)));
    rejected('a column for each component', force(element, 64, none));
    rejected('displacement', force(contact, 64, [0; NaN; 0]));
    rejected('no command contacts', @() microslip('contacts', p));
    rejected('different interfaces', @() other_header('contact', p));
    check('an error leaves the workspace usable', norm(microslip('harmonic_force', contact, 64, zeros(3, 1))), 0);
end

function rejected(message, call)
    found = 'no error';
    try
        call();
    catch failure
        found = failure.message;
    end
    check(['"', message, '" in the message: ', found], double(isempty(strfind(found, message))), 0);
end
